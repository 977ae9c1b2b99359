#include "identification/motion_effects/motion_effect.hpp"

namespace snare::identification {

/// Gain of a sensor: (I.23).
std::vector<MotionEffect> sensor_gain_effects(const MotionModel& model) {
  std::vector<MotionEffect> effects;
  for (const ChannelPlace& channel : channel_places(model)) {
    MotionNumber number;
    number.key = "sensor_gain[" + channel.column + "]";
    number.unit = "";
    number.declared = 1.0;
    number.scale = 0.01;
    number.signal = [column = channel.column](SignalChanges& changes, double value) { changes[column].gain = value; };
    effects.push_back({.name = "sensor_gain",
                       .place = channel.column,
                       .channel = "sensor",
                       .meaning = "the sensor has another gain",
                       .numbers = {number},
                       .plausible_lower = 0.5,
                       .plausible_upper = 2.0,
                       .one_sided = false,
                       .independent_check = "calibrate the sensor against a reference"});
  }
  return effects;
}

}  // namespace snare::identification
