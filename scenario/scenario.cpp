#include "scenario/scenario.hpp"

#include "base/toml_reader.hpp"
#include "scenario/composed_scenario.hpp"
#include "scenario/include.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace snare::scenario {

using base::TomlDocument;
using base::TomlNode;

namespace {

constexpr std::string_view older_schema = "snare-scenario/1";

std::string text_of(const TomlNode& root, std::string_view key) {
  const TomlNode* node = root.find(key);
  return node != nullptr && node->kind == TomlNode::Kind::text ? node->text : std::string();
}

/// What a file of the older schema is to become.
std::string way_from_older(const TomlNode& root) {
  constexpr std::string_view page = "docs/scenario_file.md, \"From snare-scenario/1\"";
  struct Way {
    std::string_view kind, lists;
  };
  constexpr Way ways[] = {{"contact", "[[wires]], [[bodies]] and [[shapes]]"},
                          {"arm_contact", "[[arms]], [[wires]], [[bodies]] and [[shapes]]"},
                          {"joint_step", "[[arms]] with deflections_deg"},
                          {"tip_impulse", "[[arms]] and [[loads]]"},
                          {"joint_motion", "[[arms]] and [[drives]]"}};
  const std::string kind = text_of(root, "kind");
  const bool lists = std::ranges::any_of(std::initializer_list<std::string_view>{"wires", "bodies", "shapes"},
                                         [&root](std::string_view key) { return root.find(key) != nullptr; });
  if (kind == "contact" && lists)
    return fmt::format("is read no more: change the line to schema = \"{}\" and take kind out",
                       composed_schema);
  for (const Way& way : ways) {
    if (way.kind == kind)
      return fmt::format("is read no more: {} of \"{}\" say what kind = \"{}\" said: {}", way.lists,
                         composed_schema, kind, page);
  }
  return fmt::format("is read no more: must be \"{}\": {}", composed_schema, page);
}

/// The schema decides which keys a file may have: without it nothing else is worth saying.
void require_lists(const std::filesystem::path& file, const TomlNode& root) {
  const std::string schema = text_of(root, "schema");
  const auto fail = [&](const char* key, const std::string& value, std::string requirement) {
    const TomlNode* node = root.find(key);
    throw base::InputError(
        {file.string(), node != nullptr ? node->line : 0, key, value, std::move(requirement)});
  };
  if (schema == older_schema) fail("schema", fmt::format("\"{}\"", schema), way_from_older(root));
  if (schema != composed_schema) fail("schema", schema, fmt::format("must be \"{}\"", composed_schema));
  if (root.find("kind") != nullptr)
    fail("kind", text_of(root, "kind"),
         fmt::format("belongs to older files: take the line out, a file of {} lists what there is", schema));
}

}  // namespace

Scenario read_scenario(const std::filesystem::path& file, const std::vector<base::Override>& overrides) {
  // less those of the list of parts, and those of the arms' files
  std::vector<base::Override> own = overrides;
  const TomlNode written = read_with_parts(file, own);
  const ArmOverrides arms = take_arm_overrides(own);
  TomlNode looked_at = written;
  std::vector<base::InputProblem> ignored;  // the document tells them
  for (const base::Override& one : own) base::apply_override(looked_at, one, ignored);
  require_lists(file, looked_at);

  const auto read = [&](WireMesh mesh) {
    TomlDocument document(file.string(), written, own);
    const base::TomlTable root = document.root();
    Scenario scenario;
    base::require_schema(root, composed_schema);
    scenario.title = root.text("title");
    scenario.source = root.text_or("source", "");
    scenario.motions = read_composition(document, file.parent_path(), arms, mesh);
    return scenario;
  };
  Scenario scenario = read(WireMesh::declared);
  WireMotions& motions = scenario.motions;
  if (motions.output.modes && !motions.runs.front().motion.wires.empty())
    motions.on_half_mesh = std::move(read(WireMesh::halved).motions.runs.front().motion);
  return scenario;
}

}  // namespace snare::scenario
