#include "multibody/friction_law.hpp"

#include <cmath>

namespace snare::multibody {

double FrictionLaw::torque(int direction, double velocity) const {
  const double ratio = velocity / stribeck_velocity;
  return direction * (coulomb + (breakaway - coulomb) * std::exp(-ratio * ratio)) + viscous * velocity;
}

double FrictionLaw::slope(int direction, double velocity) const {
  const double ratio = velocity / stribeck_velocity;
  return -direction * (breakaway - coulomb) * std::exp(-ratio * ratio) * 2.0 * ratio / stribeck_velocity +
         viscous;
}

FrictionLaw FrictionLaw::with_back_drive(double torque) const {
  FrictionLaw law = *this;
  law.coulomb += torque;
  law.breakaway += torque;
  return law;
}

}  // namespace snare::multibody
