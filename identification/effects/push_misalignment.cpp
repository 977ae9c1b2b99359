#include "identification/effects/effect.hpp"

#include "base/units.hpp"

namespace snare::identification {

namespace {

/// Angle of the pusher's motion from the normal of the chord.
Parameter misalignment() {
  return {.key = "pusher.misalignment_deg",
          .unit = "deg",
          .unit_size = base::degree,
          .number = member([](auto& p, auto&) -> auto& { return p.pusher.misalignment; }),
          .limits = [](const PushProblem&) { return between(-45.0 * base::degree, 45.0 * base::degree); },
          .step = 1e-6};
}

}  // namespace

/// The push is not square to the chord: the direction is turned in the plane of the wire.
Effect push_misalignment_effect() {
  return {.name = "push_misalignment",
          .channel = Channel::geometry,
          .meaning = "the pusher does not move square to the chord",
          .numbers = {{misalignment(), -10.0, 10.0}},
          .independent_check = "measure the angle of the pusher's guide against the line through the mounts"};
}

}  // namespace snare::identification
