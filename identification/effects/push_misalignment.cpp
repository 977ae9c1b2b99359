#include "identification/effects/effect.hpp"

#include "base/units.hpp"

namespace snare::identification {

namespace {

/// Angle of the pusher's motion from the normal of the chord.
Parameter misalignment() {
  return {.key = "pusher.misalignment_deg",
          .unit = "deg",
          .unit_size = base::degree,
          .get = [](const PushProblem& p, const ReadingModel&) { return p.pusher.misalignment; },
          .set = [](PushProblem& p, ReadingModel&, double v) { p.pusher.misalignment = v; },
          .lower = [](const PushProblem&) { return -45.0 * base::degree; },
          .upper = [](const PushProblem&) { return 45.0 * base::degree; },
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
