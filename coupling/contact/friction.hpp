#pragma once

#include <Eigen/Core>

namespace snare::coupling {

/// How friction answers.                                                                     theory.md (M.9)
enum class ContactFriction {
  stick_slip,  ///< a bristle in series with a slider: rests under load, slides with Coulomb's force
  smooth       ///< Coulomb's force smoothed over the sliding speed: creeps under load
};

/// Coulomb friction between wire and body.
///
/// The bristle is a spring and a dashpot side by side. Its stiffness is k = static_coefficient bristle_force /
/// bristle_displacement [N/m]: at the normal force bristle_force the contact gives by bristle_displacement before it
/// slips. The default, 1 um at 10 N, is the order of two steel cylinders of 1.5 mm and 6 mm (Mindlin 1949: k = 8 a G*,
/// 7e6 N/m at 10 N, 0.4 um): small beside every travel of interest, large beside the tolerances.
struct MotionFriction {
  double static_coefficient = 0.0;   ///< >= 0: of the stick; of the slip up to static_speed
  double dynamic_coefficient = 0.0;  ///< from dynamic_speed on, >= 0; at most the static one with stick and slip
  double static_speed = 1e-3;        ///< smooth: below it the friction falls to zero [m/s], > 0. stick_slip: >= 0
  double dynamic_speed = 1.0;  ///< [m/s], > static_speed; stick_slip: both 0 let the slip have the dynamic one at once
  ContactFriction law = ContactFriction::stick_slip;
  double bristle_displacement = 1e-6;  ///< [m], > 0
  double bristle_force = 10.0;         ///< normal force to which the displacement belongs [N], > 0
  double bristle_time = 1e-5;          ///< dashpot over spring [s], > 0

  [[nodiscard]] bool acts() const { return static_coefficient > 0.0 || dynamic_coefficient > 0.0; }
  [[nodiscard]] bool has_bristle() const { return acts() && law == ContactFriction::stick_slip; }
  /// k [N/m].
  [[nodiscard]] double bristle_stiffness() const { return static_coefficient * bristle_force / bristle_displacement; }
};

enum class FrictionMode { stick, slip };

/// Friction in the tangent plane and its derivatives. `force` is what the wire exerts on the body [N].
struct TangentForce {
  Eigen::Vector2d force = Eigen::Vector2d::Zero();
  Eigen::Matrix2d by_bristle = Eigen::Matrix2d::Zero();  ///< [N/m]
  Eigen::Matrix2d by_sliding = Eigen::Matrix2d::Zero();  ///< [N s/m]
  Eigen::Vector2d by_normal = Eigen::Vector2d::Zero();   ///< [-]
};

/// Where a bristle stands: its deflection z [m] and the wire's velocity against the body w [m/s], in the tangent
/// plane's axes, and the normal force [N].
struct BristleState {
  Eigen::Vector2d bristle = Eigen::Vector2d::Zero();
  Eigen::Vector2d sliding = Eigen::Vector2d::Zero();
  double normal = 0.0;
};

/// Coefficient of friction in the slip at a sliding speed [m/s] >= 0: static up to static_speed, dynamic from
/// dynamic_speed on, a cubic step between.
[[nodiscard]] double slip_coefficient(const MotionFriction& friction, double speed);

/// Friction by the law that `friction` names; `mode` is that of a bristle.
///   smooth:  f = mu(s)/s lambda w
///   stick:   f = k e,                  e = z + tau w
///   slip:    f = mu(s) lambda e/|e|
[[nodiscard]] TangentForce tangent_force(const MotionFriction& friction, FrictionMode mode, const BristleState& at);

/// dz/dt = (f/k - z)/tau [m/s]: w in the stick, w less the sliding of the slider in the slip.
[[nodiscard]] Eigen::Vector2d bristle_rate(const MotionFriction& friction, FrictionMode mode, const BristleState& at);

/// What keeps a bristle in its mode [N]: positive inside, zero where the mode ends.
///   stick:  mu_s lambda (1 + margin) - k |e|,    slip:  k |e| - mu(s) lambda
[[nodiscard]] double friction_margin(const MotionFriction& friction, FrictionMode mode, const BristleState& at);

/// By this share of Coulomb's limit the force must exceed it before the slip begins: with equal coefficients both modes
/// end where the other begins, and the integrator's noise in lambda would switch to and fro there.
inline constexpr double slip_onset_margin = 1e-4;

/// Power that the friction turns into heat [W], never negative in the right mode: k tau |z'|^2 + |f| |w - z'|.
[[nodiscard]] double friction_heat(const MotionFriction& friction, FrictionMode mode, const BristleState& at);

}  // namespace snare::coupling
