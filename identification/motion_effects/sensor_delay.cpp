#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Delay of a sensor: (I.23).
std::vector<RecordEffect> sensor_delay_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const ChannelPlace& channel : channel_places(model)) {
    RecordNumber number;
    number.key = "sensor_delay[" + channel.column + "]";
    number.unit = "s";
    number.declared = 0.0;
    number.scale = channel.interval;
    number.signal = [column = channel.column](SignalChanges& changes, double value) {
      changes[column].delay = value;
    };
    effects.push_back({.name = "sensor_delay",
                       .place = channel.column,
                       .channel = "sensor",
                       .meaning = "the sensor tells late",
                       .numbers = {number},
                       .plausible_lower = -0.5,
                       .plausible_upper = 0.5,
                       .one_sided = false,
                       .independent_check = "compare the sensor with a faster one on a step"});
  }
  return effects;
}

}  // namespace snare::identification
