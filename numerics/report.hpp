#pragma once

#include <string>
#include <utility>

namespace snare::numerics {

/// How an iteration ended.
enum class Termination {
  converged,        ///< residual below its tolerance
  iteration_limit,  ///< the allowed number of iterations did not suffice
  step_too_small,   ///< the path could not be followed with the smallest allowed step
  singular_matrix,  ///< the tangent matrix could not be factorised
  not_finite,       ///< a NaN or infinity appeared in the residual
  interrupted,      ///< the caller asked to stop
  stalled           ///< it went on, but so slowly that it was given up
};

/// What a solver returns beside its result. A failure to converge is data, not an exception.
struct [[nodiscard]] SolveReport {
  Termination termination = Termination::converged;
  int iterations = 0;          ///< Newton iterations spent
  double residual_norm = 0.0;  ///< largest scaled residual at the end [-]
  std::string message;         ///< one sentence for a person; empty when converged

  /// Whether the result is what was asked for.
  [[nodiscard]] bool usable() const noexcept { return termination == Termination::converged; }
  /// Says how it ended and why.
  SolveReport& end(Termination how, std::string why = {}) {
    termination = how;
    message = std::move(why);
    return *this;
  }
};

}  // namespace snare::numerics
