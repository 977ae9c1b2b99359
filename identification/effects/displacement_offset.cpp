#include "identification/effects/effect.hpp"

#include "base/units.hpp"

namespace snare::identification {

namespace {

/// Recorded displacement at the first touch: the travel falls as it grows.
Parameter recorded_displacement() {
  return {.key = "reading.displacement_offset_mm",
          .unit = "mm",
          .unit_size = base::mm,
          .number = member([](auto&, auto& r) -> auto& { return r.displacement_offset; }),
          .limits = [](const PushProblem&) { return between(-5e-3, 5e-3); },
          .step = 1e-7,
          .derivative = Derivative::travel};
}

}  // namespace

/// The recorded travel does not begin at the first touch.
Effect displacement_offset_effect() {
  return {.name = "displacement_offset",
          .channel = Channel::sensor,
          .meaning = "the zero of the travel is not at the first touch",
          .numbers = {{recorded_displacement(), -3.0, 3.0}},
          .independent_check =
              "find the first touch electrically or by eye, and begin the record well before it"};
}

}  // namespace snare::identification
