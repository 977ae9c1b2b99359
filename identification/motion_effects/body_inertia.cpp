#include "identification/motion_effects/motion_effect.hpp"

namespace snare::identification {

/// Moments of inertia of a body, all three by one factor.
std::vector<MotionEffect> body_inertia_effects(const MotionModel& model) {
  std::vector<MotionEffect> effects;
  for (const std::string& name : model.declared().names("bodies")) {
    const std::string key = "bodies[" + name + "].inertia_kg_m2";
    std::vector<double> declared;
    for (const char* axis : {"[1]", "[2]", "[3]"})
      declared.push_back(model.declared().number(key + axis).value_or(0.0));
    if (!(declared[0] > 0.0)) continue;
    MotionNumber factor = number_at(key + ".factor", 1.0, 0.02);
    factor.lower = 0.01;
    factor.upper = 100.0;
    factor.unit = "";
    factor.overrides = [key, declared](double f) {
      return std::vector<base::Override>{{key, "[" + exact_text(f * declared[0]) + ", " + exact_text(f * declared[1]) +
                                                   ", " + exact_text(f * declared[2]) + "]"}};
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
