#pragma once

#include "numerics/ida.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>

namespace snare::numerics {

/// What a motion spends: evaluations of its equations in the window that is open. Counts and no times of the
/// clock, so that the same input ends at the same step everywhere. Goes through checkpoints.
///                                                                                           theory.md (M.30)
struct Effort {
  long evaluations = 0;  ///< of the residual since the window began
  double since = 0.0;    ///< when it began [s]
};

/// Tells an integration that gets nowhere from one that is long: whenever a window of evaluations is full,
/// the time that they brought is looked at. Where it is less than the least, and what is left would take more
/// than another window, the integration has stalled.
///                                                                                           theory.md (M.30)
class Progress {
 public:
  /// least: what a window must bring [s], >= 0; 0: nothing.
  explicit Progress(double least = 0.0) : least_(least) {}

  /// To be called after every step; `evaluations`: that it took, `end`: of the motion [s]. Why it has
  /// stalled, or nothing.
  [[nodiscard]] std::optional<std::string> add(const Ida& ida, long evaluations, double end, Effort& effort);

  /// Evaluations of a window: 40,000, and of few unknowns as many as make 5e7 rows. That is 5 to 30 s of a
  /// core for up to some thousand unknowns (0.1 us a row, with all that belongs to its evaluation; 0.5 us
  /// with a matrix for every step).
  [[nodiscard]] static long window(long unknowns);

 private:
  [[nodiscard]] std::string why(const Ida& ida, double end, const Effort& effort) const;

  static constexpr int sampled = 16;  // one step in so many is looked at
  double least_;
  long steps_ = 0;
  // steps that were looked at, by what limited them and by block
  std::array<std::map<int, long>, step_limits> limited_;
};

}  // namespace snare::numerics
