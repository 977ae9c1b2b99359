#include "identification/records/declared_scenario.hpp"

#include "base/files.hpp"
#include "base/toml_reader.hpp"
#include "scenario/composed_scenario.hpp"
#include "scenario/include.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace snare::identification {

using base::TomlNode;

namespace {

const TomlNode* element(const TomlNode& array, const std::string& label) {
  for (std::size_t i = 0; i < array.items.size(); ++i)
    if (base::element_label(array.items[i], i) == label) return &array.items[i];
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(label.data(), label.data() + label.size(), number);
  const bool counts = error == std::errc() && end == label.data() + label.size();
  return counts && number >= 1 && number <= array.items.size() ? &array.items[number - 1] : nullptr;
}

/// Follows "a.b[c].d".
const TomlNode* follow(const TomlNode* node, std::string_view path) {
  while (node != nullptr && !path.empty()) {
    const std::size_t end = path.find_first_of(".[");
    node = node->find(path.substr(0, end));
    if (end == std::string_view::npos) return node;
    const bool bracket = path[end] == '[';
    path.remove_prefix(end + 1);
    if (!bracket) continue;
    const std::size_t close = path.find(']');
    if (close == std::string_view::npos || node == nullptr) return nullptr;
    node = element(*node, std::string(path.substr(0, close)));
    path.remove_prefix(close + 1);
    if (path.starts_with('.')) path.remove_prefix(1);
  }
  return node;
}

}  // namespace

const TomlNode* DeclaredScenario::find(const std::string& key) const {
  std::vector<base::Override> one{{key, "0"}};
  const scenario::ArmOverrides of_arms = scenario::take_arm_overrides(one);
  if (of_arms.empty()) return follow(&scenario, key);
  const auto& [name, keys] = *of_arms.begin();
  const auto arm = arms.find(name);
  if (arm == arms.end()) return nullptr;
  const std::string& inner = keys.front().key;
  if (const TomlNode* found = follow(&arm->second, inner)) return found;
  constexpr std::string_view joint = "joint.";
  const std::size_t dot = inner.find_last_of('.');
  if (!inner.starts_with(joint) || dot == std::string::npos) return nullptr;
  return follow(&arm->second, "every_joint" + inner.substr(dot));
}

std::optional<double> DeclaredScenario::number(const std::string& key) const {
  const TomlNode* found = find(key);
  return found != nullptr && found->kind == TomlNode::Kind::number ? std::optional(found->number)
                                                                   : std::nullopt;
}

std::string DeclaredScenario::key_of(const std::string& key) const {
  constexpr std::string_view joint = "].joint.";
  const std::size_t at = key.find(joint), dot = key.find_last_of('.');
  constexpr std::string_view list = "arms[";
  if (!key.starts_with(list) || at == std::string::npos || dot < at + joint.size()) return key;
  const auto arm = arms.find(key.substr(list.size(), at - list.size()));
  if (arm == arms.end() || follow(&arm->second, std::string_view(key).substr(at + 2)) != nullptr) return key;
  return key.substr(0, at + 2) + "every_joint" + key.substr(dot);
}

std::optional<double> StandingNumbers::number(const std::string& key) const {
  for (const std::string& one : {key, declared.key_of(key)}) {
    const auto last =
        std::find_if(set.rbegin(), set.rend(), [&](const base::Override& o) { return o.key == one; });
    double value = 0.0;
    if (last == set.rend()) continue;
    const char* const end = last->value.data() + last->value.size();
    const auto [stop, error] = std::from_chars(last->value.data(), end, value);
    if (error == std::errc() && stop == end) return value;
  }
  return declared.number(key);
}

std::optional<std::string> DeclaredScenario::text(const std::string& key) const {
  const TomlNode* found = find(key);
  return found != nullptr && found->kind == TomlNode::Kind::text ? std::optional(found->text) : std::nullopt;
}

std::vector<std::string> DeclaredScenario::names(const std::string& list) const {
  std::vector<std::string> names;
  const TomlNode* found = follow(&scenario, list);
  if (found == nullptr) return names;
  for (std::size_t i = 0; i < found->items.size(); ++i)
    names.push_back(base::element_label(found->items[i], i));
  return names;
}

DeclaredScenario declared_scenario(const RecordSet& set, const std::vector<base::Override>& more) {
  const auto parse = [](const std::filesystem::path& file) {
    return base::parse_toml(file.string(), base::read_text(file, base::TomlDocument::size_limit));
  };
  DeclaredScenario declared;
  std::vector<base::Override> own = set.set;
  own.insert(own.end(), more.begin(), more.end());
  declared.scenario = scenario::read_with_parts(set.scenario, own);
  const scenario::ArmOverrides of_arms = scenario::take_arm_overrides(own);
  std::vector<base::InputProblem> problems;
  for (const base::Override& one : own) base::apply_override(declared.scenario, one, problems);
  if (const TomlNode* arms = declared.scenario.find("arms")) {
    for (std::size_t k = 0; k < arms->items.size(); ++k) {
      const TomlNode* file = arms->items[k].find("file");
      if (file == nullptr || file->kind != TomlNode::Kind::text) continue;
      const std::string name = base::element_label(arms->items[k], k);
      declared.arms[name] = parse(set.scenario.parent_path() / file->text);
      if (const auto found = of_arms.find(name); found != of_arms.end())
        for (const base::Override& one : found->second)
          base::apply_override(declared.arms[name], one, problems);
    }
  }
  if (!problems.empty()) throw base::InputError(problems);
  return declared;
}

}  // namespace snare::identification
