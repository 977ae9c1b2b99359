#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Gain of a sensor: (I.23).
std::vector<RecordEffect> sensor_gain_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const ChannelPlace& channel : channel_places(model)) {
    RecordNumber number;
    number.key = "sensor_gain[" + channel.column + "]";
    number.unit = "";
    number.declared = 1.0;
    number.scale = 0.01;
    number.signal = [column = channel.column](SignalChanges& changes, double value) {
      changes[column].gain = value;
    };
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
