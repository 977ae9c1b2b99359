#include "study/benchmark_file.hpp"

#include "base/files.hpp"
#include "base/plain_name.hpp"
#include "base/toml_reader.hpp"
#include "study/fixed_keys.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace snare::study {

namespace {

using base::Range;
using base::TomlNode;
using base::TomlTable;

class BenchmarkReader {
 public:
  BenchmarkReader(const std::filesystem::path& file, const TomlNode& root, base::TomlDocument& document)
      : file_(file), root_(root), document_(document) {}

  BenchmarkFile read() {
    const TomlTable top = document_.root();
    base::require_schema(top, "snare-benchmark/1");
    BenchmarkFile result;
    result.file = file_;
    result.title = top.text_or("title", "");
    result.source = top.text_or("source", "");
    result.references = beside(top.text_or("references", "references"));
    const std::vector<TomlTable> cases = top.tables("cases");
    if (cases.empty()) top.fail("cases", "must be one or more, as [[cases]]");
    const TomlNode* nodes = root_.find("cases");
    std::set<std::string> names;
    for (std::size_t k = 0; k < cases.size(); ++k)
      result.cases.push_back(read_case(cases[k], &nodes->items[k], names));
    document_.finish();
    return result;
  }

 private:
  [[nodiscard]] std::filesystem::path beside(const std::string& name) const {
    const std::filesystem::path path(name);
    return path.is_absolute() ? path : file_.parent_path() / path;
  }

  /// A name that can be one of a file.
  static std::string take_name(const TomlTable& table, std::set<std::string>& taken) {
    std::string name = table.text("name");
    const auto plain = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    if (name.empty() && !table.has("name")) return name;
    if (name.empty() || !std::ranges::all_of(name, plain))
      table.fail("name", "must be of letters, digits and _");
    if (!taken.insert(name).second) table.fail("name", "must not be that of another one");
    return name;
  }

  static Columns read_columns(const TomlTable& owner, const TomlNode* parent, std::string_view key) {
    Columns columns;
    const TomlTable table = owner.table(key);
    const TomlNode* node = parent->find(key);
    if (node == nullptr || node->kind != TomlNode::Kind::table) return columns;
    for (const base::TomlEntry& entry : node->entries) {
      columns[entry.key] = table.text(entry.key);
      if (!base::names_a_column(entry.key))
        table.fail(entry.key, "must be a name without commas, quotes, number signs and line breaks");
    }
    return columns;
  }

  BenchmarkCase read_case(const TomlTable& table, const TomlNode* node, std::set<std::string>& names) {
    BenchmarkCase c;
    c.name = take_name(table, names);
    c.title = table.text_or("title", c.name);
    c.file = beside(table.text("file"));
    c.fixed = read_fixed_keys(table, node, "set");
    c.x = table.text_or("x", "time_s");
    c.columns = read_columns(table, node, "quantities");
    if (c.columns.contains(c.x)) table.table("quantities").fail(c.x, "must be another name than that of x");
    if (c.columns.empty())
      table.fail("quantities", "must be one or more: a name = \"the column of the history\"");
    const TomlTable touches = table.table("touch_above");
    for (const auto& [name, column] : c.columns)
      if (touches.has(name)) c.touch_above[name] = touches.number(name, Range::above(0.0));
    for (const auto& [name, text] : read_columns(table, node, "outcome")) {
      std::optional<Collected> field = parse_collected(name, text);
      if (field)
        c.outcome.push_back(*std::move(field));
      else
        table.table("outcome").fail(name, "must be a field of the result: \"outcome.caught\"");
    }
    c.step_at = table.optional_number("step_at_s", Range::above(0.0));
    const TomlNode* refinements = node->find("refinements");
    const std::vector<TomlTable> steps = table.tables("refinements");
    if (steps.size() < 2)
      table.fail("refinements", "must be two or more, coarse to fine, as [[cases.refinements]]");
    for (std::size_t k = 0; k < steps.size(); ++k)
      c.refinements.push_back(read_fixed_keys(steps[k], &refinements->items[k], "set"));
    const TomlNode* models = node->find("models");
    const std::vector<TomlTable> list = table.tables("models");
    if (list.empty()) table.fail("models", "must be one or more, as [[cases.models]]");
    std::set<std::string> taken;
    for (std::size_t k = 0; k < list.size(); ++k)
      c.models.push_back(read_model(list[k], &models->items[k], c, taken));
    return c;
  }

  BenchmarkModel read_model(const TomlTable& table, const TomlNode* node, const BenchmarkCase& c,
                            std::set<std::string>& taken) {
    BenchmarkModel m;
    m.name = take_name(table, taken);
    if (table.has("csv")) {
      m.csv = beside(table.text("csv"));
      if (table.has("file") || table.has("set")) table.fail("csv", "must stand alone: nothing is run");
      return m;
    }
    m.file = table.has("file") ? beside(table.text("file")) : c.file;
    m.fixed = read_fixed_keys(table, node, "set");
    m.columns = c.columns;
    for (auto& [name, column] : read_columns(table, node, "quantities")) {
      if (!m.columns.contains(name)) table.table("quantities").fail(name, "must be a quantity of the case");
      m.columns[name] = column;
    }
    return m;
  }

  const std::filesystem::path& file_;
  const TomlNode& root_;
  base::TomlDocument& document_;
};

}  // namespace

BenchmarkFile read_benchmark_file(const std::filesystem::path& file,
                                  const std::vector<base::Override>& overrides) {
  TomlNode root = base::parse_toml(file.string(), base::read_text(file, base::TomlDocument::size_limit));
  std::vector<base::InputProblem> problems;
  for (const base::Override& change : overrides) base::apply_override(root, change, problems);
  base::TomlDocument document(file.string(), root);
  for (base::InputProblem& problem : problems) document.add(std::move(problem));
  return BenchmarkReader(file, root, document).read();
}

}  // namespace snare::study
