#include "identification/effects/effect.hpp"

namespace snare::identification {

/// The recorded force is not zero without contact.
Effect force_offset_effect() {
  Effect e;
  e.name = "force_offset";
  e.channel = Channel::sensor;
  e.meaning = "the load cell does not read zero without load";
  e.numbers = {{"reading.force_offset_N", -1e3, 1e3}};
  e.independent_check = "record some readings before the touch";
  return e;
}

}  // namespace snare::identification
