#include "identification/motion_effects/record_effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

constexpr double least_share = 0.2, most_share = 5.0;  // of what is declared

void declare_other(RecordEffect& effect, const std::string& key, double declared) {
  RecordNumber number = number_at(key, declared, 0.02 * declared);
  number.overrides = [key, declared](double value, const StandingNumbers& record) {
    const double there = record.number(key).value_or(declared) * (value / declared);
    return std::vector<base::Override>{{key, exact_text(there)}};
  };
  number.lower = 0.01 * declared;
  number.upper = 100.0 * declared;
  effect.plausible_lower = least_share * declared;
  effect.plausible_upper = most_share * declared;
  effect.numbers = {number};
}

}  // namespace

std::vector<JointPlace> joint_places(const RecordModel& model) {
  std::vector<JointPlace> places;
  for (const auto& [name, use] : model.joints()) {
    const std::size_t colons = name.find("::");
    const std::string arm = name.substr(0, colons), joint = name.substr(colons + 2);
    if (model.declared().arms.contains(arm))
      places.push_back({name, fmt::format("arms[{}].joint.{}.", arm, joint), use});
  }
  return places;
}

RecordNumber number_at(const std::string& key, double null, double scale) {
  RecordNumber number = keyed_number(key, null);
  number.scale = scale;
  number.overrides = [key, null](double value, const StandingNumbers& record) {
    return std::vector<base::Override>{{key, exact_text(value + (record.number(key).value_or(null) - null))}};
  };
  return number;
}

std::vector<RecordEffect> other_number(const RecordModel& model, const std::string& list,
                                       const std::string& key, const RecordEffect& what) {
  std::vector<RecordEffect> effects;
  for (const std::string& name : model.declared().names(list)) {
    const std::string full = fmt::format("{}[{}].{}", list, name, key);
    const std::optional<double> declared = model.declared().number(full);
    if (!declared || !(*declared > 0.0)) continue;
    RecordEffect effect = what;
    effect.place = name;
    declare_other(effect, full, *declared);
    effects.push_back(effect);
  }
  return effects;
}

std::vector<RecordEffect> other_wire_number(const RecordModel& model, const std::string& key,
                                            const RecordEffect& what) {
  std::vector<RecordEffect> effects = other_number(model, "wires", key, what);
  for (RecordEffect& of_snare : other_number(model, "snares", "wire." + key, what))
    effects.push_back(std::move(of_snare));
  return effects;
}

std::vector<RecordEffect> other_joint_number(const RecordModel& model, const std::string& key,
                                             const RecordEffect& what) {
  std::vector<RecordEffect> effects;
  for (const JointPlace& joint : joint_places(model)) {
    const std::optional<double> declared = model.declared().number(joint.prefix + key);
    if (!declared || !(*declared > 0.0)) continue;
    RecordEffect effect = what;
    effect.place = joint.name;
    declare_other(effect, joint.prefix + key, *declared);
    effects.push_back(effect);
  }
  return effects;
}

std::vector<RecordEffect> other_body_vector(const RecordModel& model, const std::string& key,
                                            const RecordEffect& what, double scale) {
  std::vector<RecordEffect> effects;
  for (const std::string& name : model.declared().names("bodies")) {
    const std::string whole = fmt::format("bodies[{}].{}", name, key);
    RecordEffect effect = what;
    effect.place = name;
    for (const char* axis : {"[1]", "[2]", "[3]"}) {
      if (const auto declared = model.declared().number(whole + axis);
          declared && !is_fitted(model, whole + axis))
        effect.numbers.push_back(number_at(whole + axis, *declared, scale));
    }
    if (!effect.numbers.empty()) effects.push_back(effect);
  }
  return effects;
}

bool is_fitted(const RecordModel& model, const std::string& key) {
  const std::vector<FreeNumber>& free = model.records().free;
  return std::any_of(free.begin(), free.end(), [&](const FreeNumber& f) {
    return key == f.key || (key.starts_with(f.key) && key[f.key.size()] == '[');
  });
}

std::vector<ChannelPlace> channel_places(const RecordModel& model) {
  std::vector<ChannelPlace> places;
  const RecordSet& set = model.records();
  for (const std::size_t r : set.used(false)) {
    const Record& record = set.records[r];
    for (const RecordChannel& c : record.channels) {
      const std::string& column = model.column(c);
      if (!c.fitted ||
          std::any_of(places.begin(), places.end(), [&](const auto& p) { return p.column == column; }))
        continue;
      const auto n = static_cast<double>(c.values.size());
      const double way = record.times[record.times.size() - 1] - record.times[0];
      places.push_back(
          {column, std::sqrt((c.values.array() - c.values.mean()).square().sum() / n), way / (n - 1.0), way});
    }
  }
  return places;
}

}  // namespace snare::identification
