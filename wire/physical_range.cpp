#include "wire/physical_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::wire {

namespace {

constexpr double stiffest_metal = 411e9;   // tungsten [Pa]
constexpr double densest_metal = 22590.0;  // osmium [kg/m^3]
constexpr double rounding = 1.02;          // declared stiffnesses are rounded

double area(const WireSpecification& wire) {
  return std::numbers::pi * wire.diameter * wire.diameter / 4.0;
}

/// A number of a sentence: a wire of no section has a stress beyond all numbers.
std::string shown(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "more than 1e308";
}

std::string in_mm(double metres) {
  return fmt::format("{:.4g} mm", 1e3 * metres);
}

}  // namespace

double strongest_wire(double diameter) {
  return 2211e6 * std::pow(std::clamp(1e3 * diameter, 0.1, 6.5), -0.145);
}

double largest_stress(const WireSpecification& wire, double tension, double bending_moment) {
  const bool as_its_section = wire.construction == Construction::solid && !wire.bending_stiffness_override &&
                              !wire.yielding && wire.bending_profile.empty();
  const double d = wire.diameter;
  const double bending =
      as_its_section ? 32.0 * std::abs(bending_moment) / (std::numbers::pi * d * d * d) : 0.0;
  return std::max(tension, 0.0) / area(wire) + bending;
}

double breaking_speed(double axial_stiffness, double mass_per_length, double strength) {
  const double strain = strength / axial_stiffness;
  const double wave = std::sqrt(axial_stiffness / mass_per_length);
  return wave * std::sqrt(std::max(0.0, 2.0 * strain * std::sqrt(strain * (1.0 + strain)) - strain * strain));
}

std::vector<std::string> doubts(const WireSpecification& wire) {
  std::vector<std::string> found;
  const double e = std::min(wire.youngs_modulus, stiffest_metal);
  if (wire.youngs_modulus > stiffest_metal) {
    found.push_back(fmt::format("the modulus of {:.4g} GPa is above that of every metal (tungsten: {:g} GPa)",
                                1e-9 * wire.youngs_modulus, 1e-9 * stiffest_metal));
  }
  if (wire.density > densest_metal) {
    found.push_back(
        fmt::format("the density of {:.5g} kg/m3 is above that of every metal (osmium: {:g} kg/m3)",
                    wire.density, densest_metal));
  }
  const auto compare = [&](const char* what, double stiffness, double solid) {
    if (!(stiffness > rounding * solid)) return;
    found.push_back(
        fmt::format("the {} stiffness is {} times that of a solid wire of {} and {:.4g} GPa: no wire of this "
                    "diameter and metal is stiffer than the solid one",
                    what, shown(stiffness / solid), in_mm(wire.diameter), 1e-9 * e));
  };
  // What follows from the modulus is no stiffer than the modulus says.
  if (wire.axial_stiffness_override) compare("axial", wire.axial_stiffness(), e * area(wire));
  if (wire.bending_stiffness_override)
    compare("bending", wire.bending_stiffness(), e * area(wire) * wire.diameter * wire.diameter / 16.0);
  return found;
}

std::vector<std::string> overload(const WireSpecification& wire, double stress) {
  const double strength = strongest_wire(wire.diameter);
  if (!(stress > strength)) return {};
  return {fmt::format(
      "the stress in the wire reaches {} GPa; the strongest wire of steel of {} breaks at {:.3g} GPa",
      shown(1e-9 * stress), in_mm(wire.diameter), 1e-9 * strength)};
}

}  // namespace snare::wire
