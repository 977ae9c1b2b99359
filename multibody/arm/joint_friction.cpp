#include "multibody/arm/joint_friction.hpp"

#include <cmath>

namespace snare::multibody {

double JointFriction::torque(int direction, double velocity) const {
  const double ratio = velocity / stribeck_velocity;
  return direction * (coulomb + (breakaway - coulomb) * std::exp(-ratio * ratio)) + viscous * velocity +
         viscous_asymmetry * std::abs(velocity) + quadratic * std::abs(velocity) * velocity + offset;
}

double JointFriction::slope(int direction, double velocity) const {
  const double ratio = velocity / stribeck_velocity;
  return -direction * (breakaway - coulomb) * std::exp(-ratio * ratio) * 2.0 * ratio / stribeck_velocity +
         viscous + (velocity < 0.0 ? -viscous_asymmetry : viscous_asymmetry) +
         2.0 * quadratic * std::abs(velocity);
}

int JointFriction::leaves(double applied) const {
  const double beyond = applied - offset;
  if (std::abs(beyond) <= breakaway) return 0;
  return beyond > 0.0 ? 1 : -1;
}

JointFriction JointFriction::with_back_drive(double torque) const {
  JointFriction law = *this;
  law.coulomb += torque;
  law.breakaway += torque;
  return law;
}

}  // namespace snare::multibody
