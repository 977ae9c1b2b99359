#pragma once

#include "coupling/statics/push_problem.hpp"

#include <array>

namespace snare::validation {

/// The wire of the published tests (Abiko et al., Table 3): solid SUS-304, 1.5 mm, 180 mm long.
[[nodiscard]] inline wire::WireSpecification declared_specification() {
  wire::WireSpecification wire;
  wire.diameter = 1.5e-3;
  wire.length = 0.180;
  wire.youngs_modulus = 193e9;
  wire.poisson_ratio = 0.29;
  wire.density = 7930.0;
  return wire;
}

/// The same between clamps 175 mm apart, pushed outward at `position` by a cylinder of `radius` (0: a knife
/// edge). [m]
[[nodiscard]] inline coupling::PushProblem declared_wire(double position, double radius) {
  coupling::PushProblem test;
  test.wire = declared_specification();
  test.mount.span = 0.175;
  test.contact_position = position;
  test.pusher.radius = radius;
  return test;
}

/// A fit F = A d^2 + B d + C of the published tests (Abiko et al., Table 4).
struct PublishedLaw {
  double position;   ///< [m]
  double a, b, c;    ///< [N/m^2], [N/m], [N]
  double r_squared;  ///< [-]
  [[nodiscard]] double force(double d) const { return (a * d + b) * d + c; }
};
inline constexpr std::array<PublishedLaw, 3> published_laws{{{0.040, 719880.0, -13.578, 0.0533, 0.9976},
                                                             {0.065, 878089.0, -1086.0, 0.2115, 0.998},
                                                             {0.090, 890183.0, -1297.6, 0.3457, 0.9975}}};

}  // namespace snare::validation
