#pragma once

#include "wire/specification.hpp"

#include <string>
#include <vector>

namespace snare::wire {

/// What wires of metal can be and bear: beyond it a computed result describes no wire that there is.
///                                                                                           theory.md (W.35)

/// Tensile strength of the strongest wire of steel of a diameter [m] that is sold, [Pa]:
///   2211 MPa (d / 1 mm)^-0.145 for 0.1 to 6.5 mm, the value of the nearer end beyond.
/// Music wire, ASTM A228, as in Shigley's Mechanical Engineering Design, 9th ed., table 10-4.
[[nodiscard]] double strongest_wire(double diameter);

/// Largest stress of a wire that carries a tension [N] and, where it is solid and as stiff in bending as its
/// section, a bending moment [N m]: T/A + 32 M / (pi d^3) [Pa]. A strand bends by what its wires slide; there
/// the tension alone counts.
[[nodiscard]] double largest_stress(const WireSpecification& wire, double tension, double bending_moment);

/// Speed of a blow across a wire at which it breaks at once, whatever hits it [m/s]:
///   c sqrt(2 e sqrt(e (1 + e)) - e^2),  c = sqrt(EA / mass_per_length),  e = strength / EA.
/// axial_stiffness [N], mass_per_length [kg/m], strength, the tension at which it breaks [N]: > 0.
/// Smith, McCrackin and Schiefer, Textile Research Journal 28 (1958), 288-302.
[[nodiscard]] double breaking_speed(double axial_stiffness, double mass_per_length, double strength);

/// What the numbers of a wire say that no wire of metal does, each as a sentence: a modulus above that of
/// tungsten (411 GPa), a density above that of osmium (22590 kg/m^3) (CRC Handbook of Chemistry and Physics),
/// axial or bending stiffness above those of the solid round section. Empty: nothing.
[[nodiscard]] std::vector<std::string> doubts(const WireSpecification& wire);

/// Whether such a wire bears a stress [Pa]; a sentence where it does not.
[[nodiscard]] std::vector<std::string> overload(const WireSpecification& wire, double stress);

}  // namespace snare::wire
