#pragma once

namespace snare::multibody {

/// Dry and viscous friction of a motor with its gear, on the output side.                    theory.md (A.11)
///
///   turning:  T = sgn(w) [T_c + (T_s - T_c) exp(-(w/w_s)^2)] + (d + sgn(w) d_0) w + d2 |w| w
///     + T_0      (Stribeck)
///   sticking: any |T - T_0| <= T_s; the motor does not turn
/// Sticking is exact: no creep. With T_s = T_c = 0 the motor never sticks. T_0 is half of what the dry
/// friction forward is larger than backward, d_0 likewise of the viscous one; alone T_0 is a constant torque
/// against turning forward, and what it takes may be negative.
struct JointFriction {
  double coulomb = 0.0;             ///< T_c [N m], >= 0
  double breakaway = 0.0;           ///< T_s [N m], >= T_c
  double stribeck_velocity = 1e-3;  ///< w_s [rad/s], > 0
  double viscous = 0.0;             ///< d [N m s/rad], >= 0
  double quadratic = 0.0;           ///< d2 [N m s^2/rad^2], >= 0
  double offset = 0.0;              ///< T_0 [N m]
  double viscous_asymmetry = 0.0;   ///< d_0 [N m s/rad], |d_0| <= d

  /// Whether the motor can stick: then it is at rest exactly.
  [[nodiscard]] bool sticks() const { return breakaway > 0.0; }
  /// Where a motor at rest goes that this torque [N m] turns: 0 it stays, else +1 or -1.
  [[nodiscard]] int leaves(double applied) const;
  /// Torque against the turning, direction +1 or -1 (also at w = 0) [N m].
  [[nodiscard]] double torque(int direction, double velocity) const;
  /// d torque / d velocity [N m s/rad].
  [[nodiscard]] double slope(int direction, double velocity) const;
  /// The same with a torque [N m], >= 0, that the load needs to drive the gear backwards on top of the dry
  /// friction.
  [[nodiscard]] JointFriction with_back_drive(double torque) const;
};

}  // namespace snare::multibody
