#include "identification/effects/effect.hpp"

#include "base/units.hpp"

namespace snare::identification {

namespace {

/// Place of the touch along the chord, shown as the change of it.
Parameter shift() {
  return {.key = "contact_position.shift_mm",
          .unit = "mm",
          .unit_size = base::mm,
          .number = member([](auto& p, auto&) -> auto& { return p.contact_position; }),
          .limits =
              [](const PushProblem& p) {
                return between(0.6 * p.contact_position,
                               p.contact_position + 0.4 * (p.mount.span - p.contact_position));
              },
          .step = 1e-7,
          .reports_change = true};
}

}  // namespace

/// The pusher touches elsewhere along the chord than declared, by the same distance in all series: a zero of
/// the slide.
Effect contact_position_effect() {
  return {
      .name = "contact_position",
      .channel = Channel::geometry,
      .meaning = "the pusher stands elsewhere along the chord than declared",
      .numbers = {{shift(), -5.0, 5.0}},
      .independent_check = "mark where the pusher touches the wire and measure its distance from the mount"};
}

}  // namespace snare::identification
