#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Time at which a phase begins that is declared by its time.
std::vector<RecordEffect> ring_delay_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const std::string& phase : model.declared().names("phases")) {
    const std::string key = "phases[" + phase + "].at_s";
    const auto declared = model.declared().number(key);
    if (!declared) continue;
    RecordNumber number = number_at(key, *declared, 1e-2);
    number.lower = 0.0;
    effects.push_back({.name = "ring_delay",
                       .place = phase,
                       .channel = "ring",
                       .meaning = "the phase began earlier or later",
                       .numbers = {number},
                       .independent_check = "compare the clocks of command and telemetry"});
  }
  return effects;
}

}  // namespace snare::identification
