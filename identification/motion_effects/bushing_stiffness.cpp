#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

namespace {

/// What a bushing gives, 1/k in the unit of that: motions go with it nearly in proportion, also where it is
/// declared as good as rigid and gives a thousand times more. In a record that declares the stiffness k
/// otherwise it gives more by the same factor.
RecordNumber compliance_of(const std::string& key, const std::string& name, const std::string& unit,
                           double stiffness) {
  const double null = 1.0 / stiffness;
  RecordNumber number = number_at(name, null, 0.02 * null);
  number.unit = unit;
  number.overrides = [key, stiffness, null](double value, const StandingNumbers& record) {
    return std::vector<base::Override>{
        {key, exact_text(record.number(key).value_or(stiffness) * (null / value))}};
  };
  number.lower = 0.01 * null;
  number.upper = 1e6 * null;
  return number;
}

}  // namespace

/// Stiffness of a bushing, as an attachment that gives: (M.22). Turning and shifting for themselves, all axes
/// by one factor.
std::vector<RecordEffect> bushing_stiffness_effects(const RecordModel& model) {
  struct Way {
    const char *key, *compliance, *unit;
  };
  std::vector<RecordEffect> effects;
  for (const Way& way : {Way{"rotational_stiffness_Nm_rad", "rotational_compliance_rad_Nm", "rad/(N m)"},
                         Way{"translational_stiffness_N_m", "translational_compliance_m_N", "m/N"}}) {
    for (RecordEffect& e :
         other_number(model, "bushings", way.key,
                      {.name = "bushing_stiffness",
                      .channel = "bushing",
                      .meaning = "the attachment is stiffer or softer",
                      .independent_check = "load the attachment statically and measure how it gives"})) {
      const std::string bushing = "bushings[" + e.place + "].";
      if (is_fitted(model, bushing + way.key)) continue;
      const double stiffness = e.numbers.front().declared;
      e.numbers = {compliance_of(bushing + way.key, bushing + way.compliance, way.unit, stiffness)};
      e.place += std::string(".") + way.key;
      e.plausible_lower = 0.2 / stiffness;
      e.plausible_upper = 1e5 / stiffness;  // a rigid one is declared by any large number
      effects.push_back(std::move(e));
    }
  }
  return effects;
}

}  // namespace snare::identification
