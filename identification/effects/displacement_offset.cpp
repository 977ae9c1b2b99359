#include "identification/effects/effect.hpp"

namespace snare::identification {

/// The recorded travel does not begin at the first touch.
Effect displacement_offset_effect() {
  Effect e;
  e.name = "displacement_offset";
  e.channel = Channel::sensor;
  e.meaning = "the zero of the travel is not at the first touch";
  e.numbers = {{"reading.displacement_offset_mm", -3.0, 3.0}};
  e.independent_check = "find the first touch electrically or by eye, and begin the record well before it";
  return e;
}

}  // namespace snare::identification
