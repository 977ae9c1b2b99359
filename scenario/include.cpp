#include "scenario/include.hpp"

#include "base/files.hpp"
#include "base/plain_name.hpp"
#include "base/toml_reader.hpp"
#include "scenario/composed_scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace snare::scenario {

using base::TomlDocument;
using base::TomlEntry;
using base::TomlNode;
using base::TomlPart;

namespace {

/// What a part may list, and the keys of an element that mean the world where they are missing.
struct PartList {
  std::string_view name;
  std::array<std::string_view, 2> world_keys = {};
};
constexpr PartList part_lists[] = {{"frames", {"frame"}},
                                   {"arms", {"base_frame"}},
                                   {"bodies", {"frame"}},
                                   {"snares", {"frame"}},
                                   {"wires", {"from_frame", "to_frame"}},
                                   {"shapes", {"frame"}},
                                   {"contacts"},
                                   {"bushings", {"frame", "other_frame"}},
                                   {"welds", {"frame"}},
                                   {"loads"},
                                   {"drives"},
                                   {"sensors", {"relative_to"}}};

constexpr std::string_view frame_keys[] = {"frame",       "other_frame", "from_frame",
                                           "to_frame",    "base_frame",  "tip_frame",
                                           "relative_to", "shaft_frame", "body"};
constexpr std::string_view name_keys[] = {"name",       "shape", "other_shape", "wire",
                                          "other_wire", "joint", "snare",       "contact"};
constexpr std::string_view file_keys[] = {"file", "course_file", "shape_file", "torque_file"};

template <std::size_t count>
bool is_one_of(std::string_view word, const std::string_view (&words)[count]) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

TomlNode* find(TomlNode& table, std::string_view key) {
  for (TomlEntry& entry : table.entries)
    if (entry.key == key) return &entry.node;
  return nullptr;
}

TomlNode text_node(std::string text, int line) {
  TomlNode node;
  node.kind = TomlNode::Kind::text;
  node.written = fmt::format("\"{}\"", text);
  node.text = std::move(text);
  node.line = line;
  return node;
}

/// Puts the names of a part into its scope, and its files where they are.
class Scope {
 public:
  Scope(std::string scope, std::filesystem::path folder, std::string file)
      : scope_(std::move(scope)), folder_(std::move(folder)), file_(std::move(file)) {}

  void enter(TomlNode& element, const PartList& list) {
    if (element.kind == TomlNode::Kind::table) {
      for (const std::string_view key : list.world_keys) {
        if (!key.empty() && stands_on_the_world(element, key, list.name))
          element.entries.push_back({std::string(key), text_node("world", element.line)});
      }
    }
    enter("", element);
  }

 private:
  static bool stands_on_the_world(const TomlNode& element, std::string_view key, std::string_view list) {
    if (element.find(key) != nullptr) return false;
    if (list == "arms") return element.find("tip_frame") == nullptr;
    if (list == "shapes") return element.find("body") == nullptr;
    return list != "sensors" || element.find("frame") != nullptr;
  }

  [[nodiscard]] std::string inside(std::string_view name) const {
    return fmt::format("{}::{}", scope_, name);
  }

  void enter(std::string_view key, TomlNode& node) {
    node.part = part_of(node.part);
    for (TomlEntry& entry : node.entries) enter(entry.key, entry.node);
    const bool of_names = key == "wires";
    for (TomlNode& item : node.items) enter(of_names ? "wire" : "", item);
    if (node.kind != TomlNode::Kind::text || node.text.empty()) return;
    constexpr std::string_view on = " on ";
    if (is_one_of(key, frame_keys)) {
      node.text = node.text == "world" ? scope_ : inside(node.text);
    } else if (key == "contact" && node.text.find(on) != std::string::npos) {
      const std::size_t at = node.text.find(on);
      node.text =
          fmt::format("{} on {}", inside(node.text.substr(0, at)), inside(node.text.substr(at + on.size())));
    } else if (is_one_of(key, name_keys)) {
      node.text = inside(node.text);
    } else if (is_one_of(key, file_keys)) {
      node.text = (folder_ / node.text).string();
    }
  }

  std::shared_ptr<const TomlPart> part_of(const std::shared_ptr<const TomlPart>& inner) {
    std::shared_ptr<const TomlPart>& part = parts_[inner];
    if (!part) {
      part = std::make_shared<const TomlPart>(inner ? TomlPart{inner->file, inside(inner->scope)}
                                                    : TomlPart{file_, scope_});
    }
    return part;
  }

  std::string scope_;
  std::filesystem::path folder_;
  std::string file_;
  std::map<std::shared_ptr<const TomlPart>, std::shared_ptr<const TomlPart>> parts_;
};

[[noreturn]] void fail(const std::filesystem::path& file, int line, std::string key, std::string value,
                       std::string requirement) {
  throw base::InputError({file.string(), line, std::move(key), std::move(value), std::move(requirement)});
}

/// A part has a schema, words about it, and lists.
void check_part(const std::filesystem::path& file, const TomlNode& root) {
  const TomlNode* schema = root.find("schema");
  if (schema == nullptr || schema->text != composed_schema)
    fail(file, schema != nullptr ? schema->line : 0, "schema", schema != nullptr ? schema->written : "",
         fmt::format("must be \"{}\"", composed_schema));
  std::vector<base::InputProblem> problems;
  for (const TomlEntry& entry : root.entries) {
    const std::string& key = entry.key;
    const bool listed = std::any_of(std::begin(part_lists), std::end(part_lists),
                                    [&key](const PartList& list) { return list.name == key; });
    if (listed || key == "schema" || key == "title" || key == "source" || key == "include") continue;
    problems.push_back(
        {file.string(), entry.node.line, key, entry.node.written,
         "belongs to the file that includes this one: a part has lists of what there is, no phases"});
  }
  if (!problems.empty()) throw base::InputError(problems);
}

constexpr std::size_t most_parts = 1000;

/// One entry of [[include]], checked.
struct Include {
  std::string name, file;
  TomlNode frame;  ///< the world of the part, as an element of [[frames]]
  int line = 0;
};

std::vector<Include> read_includes(const std::filesystem::path& file, const TomlNode& root) {
  std::vector<Include> all;
  const TomlNode* list = root.find("include");
  if (list == nullptr) return all;
  TomlNode alone;
  alone.entries.push_back({"include", *list});
  TomlDocument document(file.string(), std::move(alone));
  std::size_t index = 0;
  for (const base::TomlTable& table : document.root().tables("include")) {
    Include one;
    one.name = table.text("name");
    one.file = table.text("file");
    for (const char* key : {"frame", "position_mm", "rotation_deg", "rpy_deg"})
      static_cast<void>(table.has(key));
    if (one.name.find("::") != std::string::npos || one.name == "world")
      table.fail("name", "must be a name of its own, without \"::\" and not \"world\"");
    else
      base::require_plain_name(table, "name", one.name);
    if (std::any_of(all.begin(), all.end(), [&one](const Include& other) { return other.name == one.name; }))
      table.fail("name", "is taken by another part");
    one.frame = list->items.at(index++);
    one.line = one.frame.line;
    std::erase_if(one.frame.entries, [](const TomlEntry& entry) { return entry.key == "file"; });
    all.push_back(std::move(one));
  }
  document.finish();
  return all;
}

/// What comes before in a list: the parts' elements before those of the file itself.
class Merged {
 public:
  void add(std::string_view list, TomlNode element) {
    lists_[std::string(list)].push_back(std::move(element));
  }

  void into(TomlNode& root) {
    for (auto& [name, elements] : lists_) {
      TomlNode* list = base_list(root, name);
      if (list->kind != TomlNode::Kind::array) continue;  // not a list: its reader says so
      list->items.insert(list->items.begin(), std::make_move_iterator(elements.begin()),
                         std::make_move_iterator(elements.end()));
    }
  }

 private:
  static TomlNode* base_list(TomlNode& root, const std::string& name) {
    if (TomlNode* list = find(root, name)) return list;
    root.entries.push_back({name, {}});
    root.entries.back().node.kind = TomlNode::Kind::array;
    return &root.entries.back().node;
  }

  std::map<std::string, std::vector<TomlNode>> lists_;
};

struct Files {
  std::vector<std::filesystem::path> open;  ///< from the one that is run to the one that is read
  std::size_t parts = 0;
};

void include_parts(const std::filesystem::path& file, TomlNode& root, Files& files) {
  Merged merged;
  for (Include& one : read_includes(file, root)) {
    const std::filesystem::path part = file.parent_path() / one.file;
    std::error_code code;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(part, code);
    const std::string key = fmt::format("include[{}].file", one.name),
                      value = fmt::format("\"{}\"", one.file);
    if (std::find(files.open.begin(), files.open.end(), whole) != files.open.end())
      fail(file, one.line, key, value, "must not include itself by way of others");
    if (++files.parts > most_parts)
      fail(file, one.line, key, value, fmt::format("is beyond {} parts", most_parts));
    TomlNode tree = base::parse_toml(part.string(), base::read_text(part, TomlDocument::size_limit));
    check_part(part, tree);
    files.open.push_back(whole);
    include_parts(part, tree, files);
    files.open.pop_back();
    Scope scope(one.name, std::filesystem::path(one.file).parent_path(), part.string());
    for (const PartList& list : part_lists) {
      TomlNode* elements = find(tree, list.name);
      if (elements == nullptr) continue;
      if (elements->kind != TomlNode::Kind::array)
        fail(part, elements->line, std::string(list.name), elements->written,
             fmt::format("must be tables, each headed [[{}]]", list.name));
      for (TomlNode& element : elements->items) {
        scope.enter(element, list);
        merged.add(list.name, std::move(element));
      }
    }
    merged.add("frames", std::move(one.frame));
  }
  merged.into(root);
  std::erase_if(root.entries, [](const TomlEntry& entry) { return entry.key == "include"; });
}

}  // namespace

TomlNode read_with_parts(const std::filesystem::path& file, std::vector<base::Override>& overrides) {
  TomlNode root = base::parse_toml(file.string(), base::read_text(file, TomlDocument::size_limit));
  std::vector<base::Override> own;
  std::vector<base::InputProblem> problems;
  for (base::Override& one : overrides) {
    if (one.key.starts_with("include["))
      base::apply_override(root, one, problems);
    else
      own.push_back(std::move(one));
  }
  overrides = std::move(own);
  if (!problems.empty()) throw base::InputError(problems);
  const TomlNode* schema = root.find("schema");
  if (schema == nullptr || schema->text != composed_schema) return root;  // older kinds know no parts
  std::error_code code;
  Files files{{std::filesystem::weakly_canonical(file, code)}};
  include_parts(file, root, files);
  return root;
}

}  // namespace snare::scenario
