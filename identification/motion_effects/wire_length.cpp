#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Unstretched length of a wire between its mounts: its slack.
std::vector<RecordEffect> wire_length_effects(const RecordModel& model) {
  // Lengths are known to a few per cent; far ones are no wires of the scenario any more.
  std::vector<RecordEffect> effects = other_wire_number(
      model, "length_mm",
      {.name = "wire_length",
       .channel = "wire",
       .meaning = "the wire has another length, so more or less slack",
       .independent_check = "measure the wire, or the ring's angle at which it gets tight"});
  for (RecordEffect& e : effects) {
    RecordNumber& n = e.numbers.front();
    n.scale = 2e-4 * n.declared;
    n.lower = 0.9 * n.declared;
    n.upper = 1.1 * n.declared;
    e.plausible_lower = 0.95 * n.declared;
    e.plausible_upper = 1.05 * n.declared;
  }
  return effects;
}

}  // namespace snare::identification
