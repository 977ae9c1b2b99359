#pragma once

#include "numerics/cubic_spline.hpp"
#include "scenario/distilled_law.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace snare::reduction {

/// One tendon with a dead band: F = k1 x + k2 x^2 + k3 x^3 over x = d - start, no force for x < 0.
///                                                                                           theory.md (R.13)
struct MujocoSpring {
  double start = 0.0;                                   ///< travel at which it begins to act [m], >= 0
  Eigen::Vector3d stiffness = Eigen::Vector3d::Zero();  ///< k1, k2, k3 [N/m, N/m^2, N/m^3], of any sign
};

/// Radius of the pin that deflects a tendon over half the distance of its sites [-].
inline constexpr double mujoco_pin_share = 0.1;

/// One tendon that the body deflects from `start` on, between two sites on either side, with a slip at its
/// yield tension.
struct MujocoSlider {
  double start = 0.0;       ///< travel at which the body meets it [m]
  double half_width = 0.0;  ///< half the distance of its sites [m], > 0
  double tension = 0.0;     ///< at which it slips [N], >= 0
  double yield = 0.0;       ///< elongation at which it slips [m], > 0
};

/// A friction loop: elastic springs for the middle of both branches, sliders for half their difference.
struct MujocoLoop {
  std::vector<MujocoSpring> springs;
  std::vector<MujocoSlider> sliders;
  double energy = 0.0;  ///< lost in a repeated cycle over the whole travel [J]
  /// Of both branches of that cycle against the load/unload law, turns left out [N].
  double largest_error = 0.0;
};

/// The law at one position as MuJoCo can have it.
struct MujocoLaw {
  double position = 0.0;              ///< [m]
  double end = 0.0;                   ///< end of the travel that was distilled [m]
  double force_range = 0.0;           ///< force at the end of the travel [N]
  double steepest = 0.0;              ///< largest stiffness, over twice the travel [N/m]
  std::vector<MujocoSpring> springs;  ///< their sum is the curve, and its tangent beyond the end
  double linear_stiffness = 0.0;      ///< of the linear form [N/m]
  double linear_error = 0.0;          ///< of the linear form against the curve, over the travel [N]
  std::optional<scenario::DistilledLoss::Dashpot> dashpot;
  std::optional<MujocoLoop> loop;
};

/// curve: force over travel from 0, a knot at the end of the travel. linear: stiffness of the linear law
/// [N/m]; empty: least squares. Throws nothing; a loop whose energy is not positive is left out.
[[nodiscard]] MujocoLaw mujoco_law(double position, const numerics::HermiteCurve& curve,
                                   std::optional<double> linear, const scenario::DistilledLoss& loss);

/// Force of springs at a travel [N].
[[nodiscard]] double force_of(const std::vector<MujocoSpring>& springs, double travel);

/// Elongation of a slider's tendon at a travel [m], as MuJoCo wraps it around a pin of a tenth of its half
/// width.
[[nodiscard]] double elongation(const MujocoSlider& slider, double travel);

/// Mass on which the springs are stable and accurate at MuJoCo's step of 2 ms: omega h = 0.2 [kg].
[[nodiscard]] double sufficient_mass(const MujocoLaw& law);

}  // namespace snare::reduction
