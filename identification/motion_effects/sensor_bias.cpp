#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Zero of a sensor: (I.23).
std::vector<RecordEffect> sensor_bias_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const ChannelPlace& channel : channel_places(model)) {
    RecordNumber number;
    number.key = "sensor_bias[" + channel.column + "]";
    number.unit = unit_of_key(channel.column);
    number.declared = 0.0;
    number.scale = 0.02 * channel.rms;
    number.signal = [column = channel.column](SignalChanges& changes, double value) {
      changes[column].bias = value;
    };
    effects.push_back({.name = "sensor_bias",
                       .place = channel.column,
                       .channel = "sensor",
                       .meaning = "the sensor has another zero",
                       .numbers = {number},
                       .one_sided = false,
                       .independent_check = "read the sensor at rest"});
  }
  return effects;
}

}  // namespace snare::identification
