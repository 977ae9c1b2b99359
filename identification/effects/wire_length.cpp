#include "identification/effects/effect.hpp"

namespace snare::identification {

/// More or less wire between the mounts than declared.
Effect wire_length_effect() {
  Effect e;
  e.name = "wire_length";
  e.channel = Channel::geometry;
  e.meaning = "the length of wire between the mounts is not as declared";
  e.numbers = {{"wire.length_mm", 0.0, 1e6}};
  e.unobservable = needs_mounts;
  e.independent_check = "mark the wire at the mounts, take it out and measure the marks' distance";
  return e;
}

}  // namespace snare::identification
