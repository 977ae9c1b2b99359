#include "wire/specification.hpp"

#include <numbers>

namespace snare::wire {

// Solid round section of diameter d (any text on strength of materials):
//   area A = pi d^2 / 4,   second moment I = pi d^4 / 64,   polar moment J = 2 I.
// With G = E / (2 (1 + nu)) the torsional stiffness is G J = E 2 I / (2 (1 + nu)) = EI / (1 + nu).

double WireSpecification::bending_stiffness() const {
  if (bending_stiffness_override) return *bending_stiffness_override;
  const double square = diameter * diameter;
  return youngs_modulus * std::numbers::pi * square * square / 64.0;
}

double WireSpecification::axial_stiffness() const {
  if (axial_stiffness_override) return *axial_stiffness_override;
  return youngs_modulus * std::numbers::pi * diameter * diameter / 4.0;
}

double WireSpecification::torsional_stiffness() const {
  if (torsional_stiffness_override) return *torsional_stiffness_override;
  return bending_stiffness() / (1.0 + poisson_ratio);
}

double WireSpecification::mass_per_length() const {
  return density * std::numbers::pi * diameter * diameter / 4.0;
}

}  // namespace snare::wire
