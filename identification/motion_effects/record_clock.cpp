#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Clock of the records: all that they tell is later, as with one delay of all sensors, (I.23). Where there
/// is one sensor, its own delay is that.
std::vector<RecordEffect> record_clock_effects(const RecordModel& model) {
  const std::vector<ChannelPlace> channels = channel_places(model);
  if (channels.size() < 2) return {};
  RecordNumber number;
  number.key = "record_clock";
  number.unit = "s";
  number.scale = channels.front().interval;
  number.signal = [](SignalChanges& changes, double value) { changes[""].delay = value; };
  return {{.name = "record_clock",
           .channel = "record",
           .meaning = "the clock of the records is behind that of the commands",
           .numbers = {number},
           .plausible_lower = -0.5,
           .plausible_upper = 0.5,
           .independent_check = "record a command beside the sensors"}};
}

}  // namespace snare::identification
