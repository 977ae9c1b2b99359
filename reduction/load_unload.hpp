#pragma once

#include "numerics/cubic_spline.hpp"

#include <optional>

namespace snare::reduction {

/// Memory of a load/unload law: 1 on the loading branch, -1 on the unloading one, between them after a turn.
struct LoadUnloadState {
  double branch = 1.0;  ///< a number without unit, -1 to 1
  double travel = 0.0;  ///< where the memory was last brought up to date [m]
};

/// A wire that dissipates by friction, at any rate alike.                                  theory.md (R.9)
///   F = L(d) [(1 + r)/2 + z (1 - r)/2],   dz = 2 dd/lambda, -1 <= z <= 1
/// L: the loading curve; r: the share of it that is left on the way back, once the turn is over; lambda: the
/// travel that the turn takes.
class LoadUnloadLaw {
 public:
  LoadUnloadLaw(numerics::HermiteCurve loading, double returned, double turn);

  /// Brings the memory to a travel and gives the force there [N].
  [[nodiscard]] double move(LoadUnloadState& state, double travel) const;
  [[nodiscard]] double returned() const noexcept { return returned_; }  ///< r [-]
  [[nodiscard]] double turn() const noexcept { return turn_; }          ///< lambda [m]
  [[nodiscard]] const numerics::HermiteCurve& loading() const noexcept { return loading_; }

 private:
  numerics::HermiteCurve loading_;
  double returned_;
  double turn_;
};

/// What one loading and unloading of the full wire loses, and the damping that stands for it.
struct Dissipation {
  double loop = 0.0;         ///< energy lost between load and unload over the whole travel [J]
  double absorbed = 0.0;     ///< energy taken up by loading [J]
  double loss_factor = 0.0;  ///< loop/(2 pi stored), stored = absorbed - loop/2 [-]
  /// c w of the dashpot that loses as much in one cycle over the whole travel d: loop = pi c w (d/2)^2 [N/m].
  /// Friction does not know the rate: the damping c follows only for a stated angular rate w.
  double damping_times_rate = 0.0;
};
[[nodiscard]] Dissipation dissipation(const numerics::HermiteCurve& loading,
                                      const numerics::HermiteCurve& unloading);

/// Two numbers fitted to one unloading from the end of the travel: r to its first 80 %, lambda to all of it.
struct LoadUnloadFit {
  LoadUnloadLaw law;
  double largest_error = 0.0;  ///< of the force on the way back, off the travels of the fit [N]
  double rms_error = 0.0;      ///< [N]
  double loop = 0.0;           ///< of the law over the same way [J]
};
[[nodiscard]] LoadUnloadFit fit_load_unload(const numerics::HermiteCurve& loading,
                                            const numerics::HermiteCurve& unloading);

}  // namespace snare::reduction
