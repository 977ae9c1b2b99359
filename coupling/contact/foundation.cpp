#include "coupling/contact/foundation.hpp"

namespace snare::coupling {

double default_modulus(double axial_stiffness, double bending_stiffness, double diameter) {
  constexpr double stiffer = 30.0;
  // EI/EA = d^2/16 of a solid round section.
  const double square = diameter > 0.0 ? diameter * diameter : 16.0 * bending_stiffness / axial_stiffness;
  return stiffer * axial_stiffness / square;
}

}  // namespace snare::coupling
