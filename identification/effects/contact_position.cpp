#include "identification/effects/effect.hpp"

namespace snare::identification {

/// The pusher touches elsewhere along the chord than declared, by the same distance in all series: a zero of the slide.
Effect contact_position_effect() {
  Effect e;
  e.name = "contact_position";
  e.channel = Channel::geometry;
  e.meaning = "the pusher stands elsewhere along the chord than declared";
  e.numbers = {{"contact_position.shift_mm", -5.0, 5.0}};
  e.independent_check = "mark where the pusher touches the wire and measure its distance from the mount";
  return e;
}

}  // namespace snare::identification
