#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

Parameter travel_bow() {
  return {.key = "travel_nonlinearity.at_half_range",
          .number = member([](auto&, auto& r) -> auto& { return r.travel_bow; }),
          .limits = [](const PushProblem&) { return between(-0.2, 0.2); },
          .step = 1e-5,
          .derivative = Derivative::travel};
}

}  // namespace

/// The travel sensor is not linear: it deviates at half of the largest travel, not at its ends.
Effect travel_nonlinearity_effect() {
  return {.name = "travel_nonlinearity",
          .channel = Channel::sensor,
          .meaning = "the travel sensor is not linear",
          .numbers = {{travel_bow(), -0.05, 0.05}},
          .unobservable = needs_readings,
          .independent_check = "compare the travel with gauge blocks, at least five over its range"};
}

}  // namespace snare::identification
