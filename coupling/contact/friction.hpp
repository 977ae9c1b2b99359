#pragma once

#include <Eigen/Core>

namespace snare::coupling {

/// How friction answers.                                                                     theory.md (M.9)
enum class ContactFriction {
  stick_slip,  ///< a bristle in series with a slider: rests under load, slides with Coulomb's force
  smooth       ///< Coulomb's force smoothed over the sliding speed: creeps under load
};

/// Coulomb friction between a wire and what it touches.
///
/// The bristle gives by `bristle_displacement` before it slides, whatever the load: its stiffness grows with the normal
/// force. The default is the order of two steel cylinders of 1.5 mm and 6 mm (Mindlin 1949: k = 8 a G*, 0.4 um at
/// 10 N): small beside every travel of interest, large beside the tolerances.
struct MotionFriction {
  double static_coefficient = 0.0;   ///< >= 0: up to static_speed [-]
  double dynamic_coefficient = 0.0;  ///< from dynamic_speed on, >= 0; at most the static one with stick and slip [-]
  double static_speed = 1e-3;        ///< smooth: below it the friction falls to zero [m/s], > 0. stick_slip: >= 0
  double dynamic_speed = 1.0;  ///< [m/s], > static_speed; stick_slip: both 0 let the slip have the dynamic one at once
  ContactFriction law = ContactFriction::stick_slip;
  double bristle_displacement = 1e-6;  ///< of the bristle when it slides [m], > 0
  double bristle_time = 1e-5;          ///< dashpot over spring of the bristle [s], > 0

  /// Whether there is friction at all.
  [[nodiscard]] bool acts() const { return static_coefficient > 0.0 || dynamic_coefficient > 0.0; }
  /// Whether it acts through a bristle: two more unknowns a place.
  [[nodiscard]] bool has_bristle() const { return acts() && law == ContactFriction::stick_slip; }
};

/// Friction in the tangent plane and its derivatives. `force` is what the wire exerts on the other side, in the unit of the
/// normal force (or load).
struct TangentForce {
  Eigen::Vector2d force = Eigen::Vector2d::Zero();
  Eigen::Matrix2d by_bristle = Eigen::Matrix2d::Zero();  ///< [N/m]
  Eigen::Matrix2d by_sliding = Eigen::Matrix2d::Zero();  ///< [N s/m]
  Eigen::Vector2d by_normal = Eigen::Vector2d::Zero();   ///< [-]
};

/// Where a bristle stands: its deflection z [m] and the wire's velocity against the other side w [m/s], in the tangent
/// plane's axes, and the normal force [N] (or load [N/m]).
struct BristleState {
  Eigen::Vector2d bristle = Eigen::Vector2d::Zero();
  Eigen::Vector2d sliding = Eigen::Vector2d::Zero();
  double normal = 0.0;
};

/// dz/dt [m/s] of a bristle with its derivatives: a spring and a dashpot side by side, in series with a slider that carries up
/// to z_m.                                                                                     theory.md (M.9)
///
///   e = z + tau w,   m = e min(1, z_m/|e|),   dz/dt = (m - z)/tau
/// Below z_m this is w: the bristle sticks without creep. Beyond, |m| = z_m along the sliding, and z follows within tau. m is the
/// nearest point of a circle, so that its derivative by e is never negative.
struct BristleRate {
  Eigen::Vector2d rate = Eigen::Vector2d::Zero();
  Eigen::Matrix2d by_sliding = Eigen::Matrix2d::Identity();  ///< [-]
  Eigen::Matrix2d by_bristle = Eigen::Matrix2d::Zero();      ///< [1/s]
};
[[nodiscard]] BristleRate bristle_rate(const MotionFriction& friction, const BristleState& at);

/// Coefficient of friction at a sliding speed [m/s] >= 0: static up to static_speed, dynamic from dynamic_speed on, a cubic
/// step between.
[[nodiscard]] double slip_coefficient(const MotionFriction& friction, double speed);

/// Friction by the law that `friction` names.
///   smooth:      f = mu(s)/s lambda w
///   stick_slip:  f = mu(s) lambda m/z_m, m as with BristleRate
[[nodiscard]] TangentForce tangent_force(const MotionFriction& friction, const BristleState& at);

}  // namespace snare::coupling
