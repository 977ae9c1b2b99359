#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Drift of a sensor: (I.23).
std::vector<RecordEffect> sensor_drift_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const ChannelPlace& channel : channel_places(model)) {
    RecordNumber number;
    number.key = "sensor_drift[" + channel.column + "]";
    number.unit = unit_of_key(channel.column) + "/s";
    number.declared = 0.0;
    number.scale = 0.02 * channel.rms / channel.duration;
    number.signal = [column = channel.column](SignalChanges& changes, double value) {
      changes[column].drift = value;
    };
    effects.push_back({.name = "sensor_drift",
                       .place = channel.column,
                       .channel = "sensor",
                       .meaning = "the zero of the sensor drifts",
                       .numbers = {number},
                       .one_sided = false,
                       .independent_check = "read the sensor at rest before and after"});
  }
  return effects;
}

}  // namespace snare::identification
