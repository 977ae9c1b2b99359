#pragma once

#include "coupling/push_test.hpp"

namespace snare::validation {

/// The wire of the published tests (Abiko et al., Table 3): solid SUS-304, 1.5 mm, 180 mm between clamps 175 mm apart, pushed
/// outward at `position` by a cylinder of `radius` (0: a knife edge). [m]
[[nodiscard]] inline coupling::PushTest declared_wire(double position, double radius) {
  coupling::PushTest test;
  test.wire.diameter = 1.5e-3;
  test.wire.length = 0.180;
  test.wire.youngs_modulus = 193e9;
  test.wire.poisson_ratio = 0.29;
  test.wire.density = 7930.0;
  test.mount.span = 0.175;
  test.contact_position = position;
  test.pusher.radius = radius;
  return test;
}

}  // namespace snare::validation
