#include "identification/effects/effect.hpp"

#include "base/units.hpp"

namespace snare::identification {

namespace {

Parameter play() {
  return {.key = "pusher_play.width_mm",
          .unit = "mm",
          .unit_size = base::mm,
          .number = member([](auto&, auto& r) -> auto& { return r.play; }),
          .limits = [](const PushProblem&) { return between(0.0, 5e-3); },
          .step = 1e-7,
          .derivative = Derivative::travel};
}

}  // namespace

/// The pusher has play: travel is lost where it turns back.
Effect pusher_play_effect() {
  return {.name = "pusher_play",
          .channel = Channel::pusher,
          .meaning = "the pusher has play where it turns back",
          .numbers = {{play(), 0.0, 2.0}},
          .one_sided = true,
          .sizes =
              [](const PushProblem&) {
                return std::vector<double>{2e-5, 2e-4};
              },
          .unobservable = needs_unloading,
          .independent_check = "read the travel near the contact with a second gauge"};
}

}  // namespace snare::identification
