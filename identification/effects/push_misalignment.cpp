#include "identification/effects/effect.hpp"

namespace snare::identification {

/// The push is not square to the chord: the direction is turned in the plane of the wire.
Effect push_misalignment_effect() {
  Effect e;
  e.name = "push_misalignment";
  e.channel = Channel::geometry;
  e.meaning = "the pusher does not move square to the chord";
  e.numbers = {{"pusher.misalignment_deg", -10.0, 10.0}};
  e.independent_check = "measure the angle of the pusher's guide against the line through the mounts";
  return e;
}

}  // namespace snare::identification
