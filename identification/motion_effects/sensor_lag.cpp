#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Low-pass filter of a sensor: (I.23).
std::vector<RecordEffect> sensor_lag_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const ChannelPlace& channel : channel_places(model)) {
    RecordNumber number;
    number.key = "sensor_lag[" + channel.column + "]";
    number.unit = "s";
    number.declared = 0.0;
    number.lower = 0.0;
    number.scale = channel.interval;
    number.signal = [column = channel.column](SignalChanges& changes, double value) {
      changes[column].lag = value;
    };
    effects.push_back(
        {.name = "sensor_lag",
         .place = channel.column,
         .channel = "sensor",
         .meaning = "the sensor filters",
         .numbers = {number},
         .plausible_upper = 0.5,
         .one_sided = true,
         .independent_check =
             "look into the settings of the amplifier; compare with a faster sensor on a step"});
  }
  return effects;
}

}  // namespace snare::identification
