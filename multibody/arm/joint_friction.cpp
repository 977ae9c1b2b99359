#include "multibody/arm/joint_friction.hpp"

#include <cmath>

namespace snare::multibody {

double JointFriction::torque(int direction, double velocity) const {
  const double ratio = velocity / stribeck_velocity;
  return direction * (coulomb + (breakaway - coulomb) * std::exp(-ratio * ratio)) + viscous * velocity;
}

double JointFriction::slope(int direction, double velocity) const {
  const double ratio = velocity / stribeck_velocity;
  return -direction * (breakaway - coulomb) * std::exp(-ratio * ratio) * 2.0 * ratio / stribeck_velocity + viscous;
}

JointFriction JointFriction::with_back_drive(double torque) const {
  JointFriction law = *this;
  law.coulomb += torque;
  law.breakaway += torque;
  return law;
}

}  // namespace snare::multibody
