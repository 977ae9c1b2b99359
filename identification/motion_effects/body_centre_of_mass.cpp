#include "identification/motion_effects/record_effect.hpp"

#include <algorithm>

namespace snare::identification {

/// Centre of mass of a body, which stands at the origin of its frame where nothing is declared. Of a body
/// that is placed in the file.
std::vector<RecordEffect> body_centre_of_mass_effects(const RecordModel& model) {
  constexpr double one_mm = 1.0, furthest = 1e4;  // [mm]
  std::vector<RecordEffect> effects;
  for (const std::string& name : model.declared().names("bodies")) {
    const std::string body = "bodies[" + name + "].", key = body + "com_mm";
    if (!model.declared().number(body + "mass_kg")) continue;  // a driven one has none
    RecordEffect effect{.name = "body_centre_of_mass",
                        .place = name,
                        .channel = "body",
                        .meaning = "the body's centre of mass is elsewhere",
                        .independent_check = "hang it up at two points, or weigh it on three"};
    for (const char* axis : {"[1]", "[2]", "[3]"}) {
      const std::string own = key + axis;
      if (is_fitted(model, own)) continue;
      RecordNumber number = number_at(own, model.declared().number(own).value_or(0.0), one_mm);
      number.overrides = [key, own, moved = number.overrides](double value, const StandingNumbers& record) {
        std::vector<base::Override> overrides = moved(value, record);
        const bool there =
            record.number(own).has_value() ||
            std::ranges::any_of(record.set, [&](const base::Override& o) { return o.key == key; });
        if (!there)
          overrides.insert(overrides.begin(),
                           {key, "[0.0, 0.0, 0.0]"});  // an element of nothing cannot be set
        return overrides;
      };
      number.lower = -furthest;
      number.upper = furthest;
      effect.numbers.push_back(number);
    }
    if (!effect.numbers.empty()) effects.push_back(effect);
  }
  return effects;
}

}  // namespace snare::identification
