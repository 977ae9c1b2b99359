#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// Recorded force without contact.
Parameter recorded_force() {
  return {.key = "reading.force_offset_N",
          .unit = "N",
          .number = member([](auto&, auto& r) -> auto& { return r.force_offset; }),
          .limits = [](const PushProblem&) { return between(-1e3, 1e3); },
          .step = 1e-3,
          .derivative = Derivative::record};
}

}  // namespace

/// The recorded force is not zero without contact.
Effect force_offset_effect() {
  return {.name = "force_offset",
          .channel = Channel::sensor,
          .meaning = "the load cell does not read zero without load",
          .numbers = {{recorded_force(), -1e3, 1e3}},
          .independent_check = "record some readings before the touch"};
}

}  // namespace snare::identification
