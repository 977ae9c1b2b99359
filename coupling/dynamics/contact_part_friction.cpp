// Friction of a point of contact: its bristle, its margin to the other mode, and what it costs.

#include "coupling/dynamics/contact_part.hpp"

namespace snare::coupling {

using numerics::VectorView;

double ContactPart::lost_power(const VectorView& y) const {
  if (!closed_) return 0.0;
  const Geometry g = geometry(y);
  // What the pair of forces takes from wire and body together; a law's spring part returns it.
  const double heat = friction_heat(contact_.friction, mode_, g.state);
  return has_law() ? heat - g.state.normal * g.gap_rate : heat;
}

double ContactPart::friction_margin(const VectorView& y) const {
  if (!closed_ || !has_bristle()) return 1.0;
  return coupling::friction_margin(contact_.friction, mode_, geometry(y).state);
}

double ContactPart::sliding_speed(const VectorView& y) const {
  return geometry(y).state.sliding.norm();
}

double ContactPart::bristle_energy(const VectorView& y) const {
  if (!has_bristle()) return 0.0;
  return 0.5 * contact_.friction.bristle_stiffness() * y.segment<2>(bristle_unknown()).squaredNorm();
}

void ContactPart::set_bristle_rate(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const {
  if (!has_bristle()) return;
  rate.segment<2>(bristle_unknown()).setZero();
  if (closed_) rate.segment<2>(bristle_unknown()) = bristle_rate(contact_.friction, mode_, geometry(y).state);
}

}  // namespace snare::coupling
