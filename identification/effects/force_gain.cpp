#include "identification/effects/effect.hpp"

namespace snare::identification {

/// The recorded force is a multiple of the true one.
Effect force_gain_effect() {
  Effect e;
  e.name = "force_gain";
  e.channel = Channel::sensor;
  e.meaning = "the load cell's calibration factor is wrong";
  e.numbers = {{"reading.force_gain", 0.5, 2.0}};
  e.independent_check = "hang a known weight on the load cell";
  return e;
}

}  // namespace snare::identification
