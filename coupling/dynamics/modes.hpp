#pragma once

#include "coupling/dynamics/model.hpp"
#include "coupling/dynamics/options.hpp"
#include "coupling/dynamics/result.hpp"

#include <string>
#include <utility>
#include <vector>

namespace snare::coupling {

/// A small oscillation of everything together about a state.                                          theory.md (M.31)
struct MotionMode {
  double frequency = 0.0;  ///< |lambda|/(2 pi): of the undamped oscillation [Hz]
  double damping = 0.0;    ///< ratio -Re lambda/|lambda| [-]; negative: it grows
  /// Shares of the kinetic energy [-], largest first: "BODY shift x" (axes of the world), "BODY turn x" (of the body), a joint with its motor, "ARM
  /// base", a wire.
  std::vector<std::pair<std::string, double>> shares;
};

/// What a motion does about a state of it.                                                              theory.md (M.31)
struct SmallMotions {
  std::vector<MotionMode> modes;  ///< ascending
  double fastest = 0.0;           ///< largest |lambda|, of what only decays, too [1/s]

  /// 2/|lambda|: the largest step of central differences on the fastest oscillation, and of Euler's method on the fastest decay [s].
  [[nodiscard]] double largest_explicit_step() const { return 2.0 / fastest; }
};

/// Most unknowns for which modes are computed: the work grows with their third power.
inline constexpr int most_unknowns_of_modes = 1200;
[[nodiscard]] int unknowns_of(const Motion& motion, const MotionOptions& options);

/// Oscillations of a motion about a state of it [SI units], by the eigenvalues of its linearised equations: contacts, drives and stuck joints stay
/// as they are, and what the state itself moves by is held. Of the modes slower than 1e-3 rad/s and overdamped ones are left out.
/// Throws base::InputError above `most_unknowns_of_modes`.                                            theory.md (M.31)
[[nodiscard]] SmallMotions small_motions_at(const Motion& motion, const MotionOptions& options,
                                            const MotionState& state);

}  // namespace snare::coupling
