#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// Recorded over true force.
Parameter gain() {
  return {.key = "reading.force_gain",
          .parametrisation = Parametrisation::ratio,
          .number = member([](auto&, auto& r) -> auto& { return r.force_gain; }),
          .limits = [](const PushProblem&) { return between(0.2, 5.0); },
          .step = 1e-3,
          .derivative = Derivative::record};
}

}  // namespace

/// The recorded force is a multiple of the true one.
Effect force_gain_effect() {
  return {.name = "force_gain",
          .channel = Channel::sensor,
          .meaning = "the load cell's calibration factor is wrong",
          .numbers = {{gain(), 0.5, 2.0}},
          .independent_check = "hang a known weight on the load cell"};
}

}  // namespace snare::identification
