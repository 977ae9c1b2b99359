#include "scenario/scenario.hpp"

#include "base/toml_reader.hpp"
#include "scenario/arm_contact_scenario.hpp"
#include "scenario/arm_reader.hpp"
#include "scenario/composed_scenario.hpp"
#include "scenario/contact_scenario.hpp"
#include "scenario/include.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace snare::scenario {

using base::TomlDocument;
using base::TomlNode;

namespace {

enum class Kind { composed, contact, arm_contact, arm_alone };

constexpr base::Choice<Kind> kinds[] = {{"contact", Kind::contact},
                                        {"arm_contact", Kind::arm_contact},
                                        {"joint_step", Kind::arm_alone},
                                        {"tip_impulse", Kind::arm_alone},
                                        {"joint_motion", Kind::arm_alone}};

/// The overrides of a scenario, and those of the file that its key `contact` names.
struct SplitOverrides {
  std::vector<base::Override> own, contact;
};

SplitOverrides split(const std::vector<base::Override>& overrides) {
  constexpr std::string_view prefix = "contact.";
  SplitOverrides result;
  for (const base::Override& one : overrides) {
    if (one.key.starts_with(prefix))
      result.contact.push_back({one.key.substr(prefix.size()), one.value});
    else
      result.own.push_back(one);
  }
  return result;
}

std::string text_of(const TomlNode& root, std::string_view key) {
  const TomlNode* node = root.find(key);
  return node != nullptr && node->kind == TomlNode::Kind::text ? node->text : std::string();
}

/// Schema and kind decide which keys a file may have and for whom overrides are: without them nothing else is worth saying.
Kind kind_of(const std::filesystem::path& file, const TomlNode& root) {
  const std::string schema = text_of(root, "schema");
  if (schema == composed_schema) {
    if (root.find("kind") != nullptr)
      throw base::InputError(
          {file.string(), 0, "kind", text_of(root, "kind"),
           fmt::format("belongs to older files: take the line out, a file of {} lists what there is", schema)});
    return Kind::composed;
  }
  if (schema != scenario_schema)
    throw base::InputError({file.string(), 0, "schema", schema,
                            fmt::format("must be \"{}\" or \"{}\"", composed_schema, scenario_schema)});
  const std::string asked = text_of(root, "kind");
  std::string known;
  for (const base::Choice<Kind>& kind : kinds) {
    if (asked == kind.name) return kind.value;
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", kind.name);
  }
  throw base::InputError({file.string(), 0, "kind", fmt::format("\"{}\"", asked), "must be one of " + known});
}

/// The keys of a file of kind "contact" that lists its bodies instead of having one [body], one [wire] and one [pusher].
constexpr std::string_view list_keys[] = {"wires", "bodies", "shapes"};

bool lists_bodies(const TomlNode& root) {
  return std::any_of(std::begin(list_keys), std::end(list_keys),
                     [&root](std::string_view key) { return root.find(key) != nullptr; });
}

void check_lists(const base::TomlTable& root) {
  for (const char* key : {"body", "wire", "mount", "pusher", "models"}) {
    if (root.has(key)) root.fail(key, "not beside lists of bodies, wires and shapes");
  }
  // Wires alone may meet each other.
  const bool wires_alone = root.has("contacts") && !root.has("bodies") && !root.has("shapes");
  for (const std::string_view key : list_keys) {
    if (!root.has(key) && !(wires_alone && key != "wires")) root.fail(key, "must be given, one table or more");
  }
}

}  // namespace

Scenario read_scenario(const std::filesystem::path& file, const std::vector<base::Override>& overrides) {
  std::vector<base::Override> own = overrides;  // less those of the list of parts, and those of the arms' files
  const TomlNode written = read_with_parts(file, own);
  const SplitOverrides split_overrides = split(overrides);
  const ArmOverrides arms = take_arm_overrides(own);
  TomlNode looked_at = written;
  std::vector<base::InputProblem> ignored;  // the document tells them
  for (const base::Override& one : own) base::apply_override(looked_at, one, ignored);
  const Kind kind = kind_of(file, looked_at);

  TomlDocument document(file.string(), written, kind == Kind::arm_contact ? split_overrides.own : own);
  const base::TomlTable root = document.root();
  Scenario scenario;
  base::require_schema(root, kind == Kind::composed ? composed_schema : scenario_schema);
  scenario.kind = kind == Kind::composed ? "composed" : root.text("kind");
  scenario.title = root.text("title");
  scenario.source = root.text_or("source", "");
  const std::filesystem::path folder = file.parent_path();
  switch (kind) {
    case Kind::composed:
      scenario.content = read_composition(document, folder, arms);
      break;
    case Kind::contact:
      if (!lists_bodies(looked_at)) {
        scenario.content = motions_of(read_contact(document));
        break;
      }
      check_lists(root);
      {
        WireMotions lists = read_composition(document, folder);
        lists.composed = false;  // results as they were
        scenario.content = std::move(lists);
      }
      break;
    case Kind::arm_contact:
      scenario.content = read_arm_contact(document, folder, split_overrides.contact);
      break;
    case Kind::arm_alone:
      scenario.content = read_arm_motion(document, folder);
  }
  return scenario;
}

}  // namespace snare::scenario
