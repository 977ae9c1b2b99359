#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// Acceleration along the bulge.
Parameter along_bulge() {
  return {.key = "gravity.along_bulge_m_s2",
          .unit = "m/s^2",
          .number = member([](auto& p, auto&) -> auto& { return p.gravity[1]; }),
          .limits = [](const PushProblem&) { return between(-100.0, 100.0); },
          .step = 1e-2};
}

}  // namespace

/// Weight along the bulge: the wire does not hang as declared.
Effect gravity_effect() {
  return {.name = "gravity",
          .channel = Channel::geometry,
          .meaning = "the wire's weight acts along the bulge",
          .numbers = {{along_bulge(), -9.9, 9.9}},
          .independent_check = "turn the bench over and repeat"};
}

}  // namespace snare::identification
