#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

Parameter lag() {
  return {.key = "data_lag.time_s",
          .unit = "s",
          .number = member([](auto&, auto& r) -> auto& { return r.lag; }),
          .limits = [](const PushProblem&) { return between(-60.0, 60.0); },
          .step = 1e-5,
          .derivative = Derivative::travel};
}

}  // namespace

/// The force is recorded later than the travel (or earlier).
Effect data_lag_effect() {
  return {.name = "data_lag",
          .channel = Channel::sensor,
          .meaning = "the record of the force is late against that of the travel",
          .numbers = {{lag(), -10.0, 10.0}},
          .unobservable = needs_times,
          .independent_check = "push at a tenth of the speed: a lag shrinks with it"};
}

}  // namespace snare::identification
