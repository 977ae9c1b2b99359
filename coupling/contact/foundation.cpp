#include "coupling/contact/foundation.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

namespace {

/// EI/EA = d^2/16 of a solid round section.
double square_of_diameter(double axial_stiffness, double bending_stiffness, double diameter) {
  return diameter > 0.0 ? diameter * diameter : 16.0 * bending_stiffness / axial_stiffness;
}

}  // namespace

double default_modulus(double axial_stiffness, double bending_stiffness, double diameter) {
  constexpr double stiffer = 30.0;
  return stiffer * axial_stiffness / square_of_diameter(axial_stiffness, bending_stiffness, diameter);
}

double mount_length(double axial_stiffness, double bending_stiffness, double diameter, double radius) {
  constexpr double diameters = 4.0;
  const double least =
      diameters * std::sqrt(square_of_diameter(axial_stiffness, bending_stiffness, diameter));
  return std::isfinite(radius) ? std::max(radius + 0.5 * diameter, least) : least;
}

}  // namespace snare::coupling
