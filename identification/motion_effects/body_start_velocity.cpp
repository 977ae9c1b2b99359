#include "identification/motion_effects/motion_effect.hpp"

namespace snare::identification {

/// Velocity of a body at the start.
std::vector<MotionEffect> body_start_velocity_effects(const MotionModel& model) {
  std::vector<MotionEffect> effects;
  for (const std::string& name : model.declared().names("bodies")) {
    const std::string key = "bodies[" + name + "].velocity_m_s";
    MotionEffect effect{.name = "body_start_velocity",
                        .place = name,
                        .channel = "body",
                        .meaning = "the body began with another velocity",
                        .independent_check = "measure the velocity just before"};
    for (const char* axis : {"[1]", "[2]", "[3]"}) {
      if (const auto declared = model.declared().number(key + axis))
        effect.numbers.push_back(number_at(key + axis, *declared, 1e-3));
    }
    if (!effect.numbers.empty()) effects.push_back(effect);
  }
  return effects;
}

}  // namespace snare::identification
