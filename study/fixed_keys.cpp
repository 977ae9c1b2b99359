#include "study/fixed_keys.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::study {

using base::TomlNode;

std::string literal_of(const TomlNode& node) {
  switch (node.kind) {
    case TomlNode::Kind::number:
      return node.integer ? fmt::format("{:.0f}", node.number) : fmt::format("{}", node.number);
    case TomlNode::Kind::boolean:
      return node.boolean ? "true" : "false";
    case TomlNode::Kind::text:
      return nlohmann::json(node.text).dump();  // a basic string of TOML is one of JSON
    case TomlNode::Kind::array: {
      std::string list;
      for (const TomlNode& item : node.items) {
        const std::string one = literal_of(item);
        if (one.empty()) return {};
        list += (list.empty() ? "" : ", ") + one;
      }
      return "[" + list + "]";
    }
    default:
      return {};
  }
}

std::vector<base::Override> read_fixed_keys(const base::TomlTable& owner, const TomlNode* parent,
                                            std::string_view name) {
  std::vector<base::Override> fixed;
  const base::TomlTable table = owner.table(name);
  const TomlNode* node = parent != nullptr ? parent->find(name) : nullptr;
  if (node == nullptr || node->kind != TomlNode::Kind::table) return fixed;
  for (const base::TomlEntry& entry : node->entries) {
    [[maybe_unused]] const bool known = table.has(entry.key);
    const std::string text = literal_of(entry.node);
    if (text.empty())
      table.fail(entry.key, "must be a number, a text, a boolean or an array of them; quote a key with dots");
    fixed.push_back({entry.key, text});
  }
  return fixed;
}

}  // namespace snare::study
