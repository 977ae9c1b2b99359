#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Moments of inertia of a body, all that are not fitted by one factor.
std::vector<RecordEffect> body_inertia_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const std::string& name : model.declared().names("bodies")) {
    const std::string key = "bodies[" + name + "].inertia_kg_m2";
    std::vector<std::pair<std::string, double>> moments;  // those that are not fitted by themselves
    for (const char* axis : {"[1]", "[2]", "[3]"}) {
      const auto declared = model.declared().number(key + axis);
      if (declared && *declared > 0.0 && !is_fitted(model, key + axis))
        moments.emplace_back(key + axis, *declared);
    }
    if (moments.empty()) continue;
    RecordNumber factor = number_at(key + ".factor", 1.0, 0.02);
    factor.lower = 0.01;
    factor.upper = 100.0;
    factor.unit = "";
    factor.overrides = [moments](double f, const StandingNumbers& record) {
      std::vector<base::Override> overrides;
      for (const auto& [moment, declared] : moments)
        overrides.push_back({moment, exact_text(f * record.number(moment).value_or(declared))});
      return overrides;
    };
    effects.push_back({.name = "body_inertia",
                       .place = name,
                       .channel = "body",
                       .meaning = "the body turns less or more easily",
                       .numbers = {factor},
                       .plausible_lower = 0.2,
                       .plausible_upper = 5.0,
                       .independent_check = "swing it as a pendulum, or spin it with a known torque"});
  }
  return effects;
}

}  // namespace snare::identification
