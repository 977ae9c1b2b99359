#include "identification/records/record_file.hpp"

#include "base/files.hpp"
#include "base/plain_name.hpp"
#include "base/toml_reader.hpp"
#include "identification/records/record_csv.hpp"
#include "identification/records/record_number.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace snare::identification {

using base::Range;
using base::TomlDocument;
using base::TomlNode;
using base::TomlTable;

namespace {

/// Of standard deviations, in the unit of their column: far below it their squares are zero.
constexpr Range sigmas{1e-30, 1e30, true};

constexpr std::string_view to_scenario = "scenario.";

/// The entries of a table whose keys the user chose, by the raw tree: the reader knows fixed keys only.
const std::vector<base::TomlEntry>* entries_of(const TomlNode* node, const char* key) {
  const TomlNode* found = node == nullptr ? nullptr : node->find(key);
  return found != nullptr && found->kind == TomlNode::Kind::table ? &found->entries : nullptr;
}

/// A TOML value as an override's text. What a node keeps of how it was written is shortened for messages.
std::string text_of(const TomlNode& node) {
  if (node.kind == TomlNode::Kind::text) return "\"" + node.text + "\"";
  if (node.kind == TomlNode::Kind::number)
    return node.integer ? fmt::format("{:.0f}", node.number) : exact_text(node.number);
  if (node.kind != TomlNode::Kind::array) return node.written;
  std::vector<std::string> items;
  for (const TomlNode& item : node.items) items.push_back(text_of(item));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

std::vector<base::Override> read_set(const TomlTable& table, const TomlNode* node) {
  std::vector<base::Override> set;
  if (!table.has("set")) return set;
  const auto* entries = entries_of(node, "set");
  if (entries == nullptr) {
    table.fail("set", "must be a table of keys of the scenario: { \"bodies[visitor].mass_kg\" = 500.0 }");
    return set;
  }
  const TomlTable known = table.table("set");
  for (const base::TomlEntry& e : *entries) {
    static_cast<void>(known.has(e.key));
    set.push_back({e.key, text_of(e.node)});
  }
  return set;
}

/// Numbers by column: `scale = { position_m = 1000.0 }`.
double number_by_column(const TomlTable& table, const char* key, const std::string& column, double otherwise,
                        Range range) {
  return table.table(key).number_or(column, otherwise, range);
}

void read_record(const TomlTable& table, const TomlNode* node, const std::filesystem::path& folder,
                 RecordSet& set) {
  Record record;
  record.name = table.text("name");
  base::require_plain_name(table, "name", record.name);
  for (const Record& other : set.records)
    if (other.name == record.name) table.fail("name", "is taken by another record");
  record.set = read_set(table, node);
  RecordCsv csv;
  csv.file = folder / table.text("file");
  csv.time_column = table.text_or("time", "time_s");
  csv.from = table.number_or("from_s", csv.from, Range::finite());
  csv.to = table.number_or("to_s", csv.to, Range::finite());
  csv.clock = table.number_or("clock_s", 0.0, Range::finite());
  csv.every = table.integer_or("every", 1, 1, 1000000);
  if (table.has("lowpass_Hz")) csv.cutoff = table.number("lowpass_Hz", Range::above(0.0));
  csv.most_gap = table.optional_number("longest_gap_s", Range::above(0.0));
  if (csv.from >= csv.to) table.fail("to_s", "must be > from_s");
  if (table.has("rows")) {
    const TomlTable rows = table.table("rows");
    if (const auto* entries = entries_of(node, "rows"))
      for (const base::TomlEntry& e : *entries)
        csv.rows.emplace_back(e.key, rows.number(e.key, Range::finite()));
  }
  const std::vector<std::string> watched = table.texts_or_none("watched");
  const auto* columns = entries_of(node, "columns");
  if (columns == nullptr || columns->empty()) {
    table.fail("columns", "must be a table of columns and sensors: { \"angle_deg\" = \"encoder\" }");
    static_cast<void>(table.has("sigma"));
    static_cast<void>(table.has("scale"));
    return;
  }
  const TomlTable named = table.table("columns");
  const bool one_sigma = table.has("sigma") && entries_of(node, "sigma") == nullptr;
  for (const base::TomlEntry& e : *columns) {
    RecordChannel channel;
    channel.column = e.key;
    channel.sensor = named.text(e.key);
    channel.fitted = std::find(watched.begin(), watched.end(), e.key) == watched.end();
    if (one_sigma)
      channel.sigma = table.optional_number("sigma", sigmas);
    else if (table.has("sigma"))
      channel.sigma = table.table("sigma").optional_number(e.key, sigmas);
    csv.columns.emplace_back(
        e.key, table.has("scale") ? number_by_column(table, "scale", e.key, 1.0, Range::finite()) : 1.0);
    record.channels.push_back(std::move(channel));
  }
  for (std::size_t k = 0; k < watched.size(); ++k)
    if (std::none_of(columns->begin(), columns->end(), [&](const auto& e) { return e.key == watched[k]; }))
      table.fail_element("watched", k, "must be one of the columns");
  if (csv.file.filename().empty()) return;
  const auto read = [&] { return read_record_csv(csv); };
  for (const std::string& problem : read_into(read, record)) table.fail("file", problem);
  set.records.push_back(std::move(record));
}

void read_families(const TomlTable& table, const TomlNode* node, RecordSet& set) {
  const TomlNode* list = node == nullptr ? nullptr : node->find("families");
  const std::vector<TomlTable> tables = table.tables("families");
  for (std::size_t k = 0; k < tables.size(); ++k) {
    RecordFamily family;
    family.name = tables[k].text("name");
    base::require_plain_name(tables[k], "name", family.name);
    for (const RecordFamily& other : set.families)
      if (other.name == family.name) tables[k].fail("name", "is taken by another family");
    family.set = read_set(tables[k], list != nullptr && k < list->items.size() ? &list->items[k] : nullptr);
    if (!tables[k].has("set")) tables[k].fail("set", "must be given: what is otherwise in this family");
    set.families.push_back(std::move(family));
  }
}

void read_fit(const TomlTable& table, const TomlNode* node, RecordSet& set) {
  static constexpr base::Choice<FitMethod> methods[] = {{"gauss_newton", FitMethod::gauss_newton},
                                                        {"nelder_mead", FitMethod::nelder_mead}};
  if (table.has("method")) set.method = table.choice("method", methods).value_or(FitMethod::gauss_newton);
  if (table.has("simplex_change")) {
    set.simplex_change = table.number("simplex_change", Range::above(0.0, 1.0));
    if (set.method != FitMethod::nelder_mead)
      table.fail("simplex_change", "only with method = \"nelder_mead\"");
  }
  std::set<std::string> keys;
  for (const bool each : {false, true}) {
    const char* list = each ? "free_each" : "free";
    const std::vector<std::string> free = table.texts_or_none(list);
    for (std::size_t k = 0; k < free.size(); ++k) {
      if (!keys.insert(free[k]).second) table.fail_element(list, k, "stands there already");
      set.free.push_back({free[k], each, {}, {}, {}, false});
    }
  }
  for (const TomlTable& one : table.tables("numbers")) {
    const std::string key = one.text("key");
    const auto found =
        std::find_if(set.free.begin(), set.free.end(), [&](const FreeNumber& f) { return f.key == key; });
    const auto lower = one.optional_number("lower", Range::finite());
    const auto upper = one.optional_number("upper", Range::finite());
    const auto scale = one.optional_number("scale", Range::above(0.0));
    if (lower && upper && *lower >= *upper) one.fail("upper", "must be > lower");
    if (found == set.free.end()) {
      one.fail("key", "must be one of fit.free or fit.free_each");
      continue;
    }
    found->lower = lower;
    found->upper = upper;
    found->scale = scale;
  }
  const std::vector<std::string> profile = table.texts_or_none("profile");
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const auto found = std::find_if(set.free.begin(), set.free.end(),
                                    [&](const FreeNumber& f) { return f.key == profile[k]; });
    if (found == set.free.end())
      table.fail_element("profile", k, "must be one of fit.free or fit.free_each");
    else
      found->profile = true;
  }
  const std::vector<std::string> heldout = table.texts_or_none("heldout");
  for (std::size_t k = 0; k < heldout.size(); ++k) {
    const auto record = std::find_if(set.records.begin(), set.records.end(),
                                     [&](const Record& r) { return r.name == heldout[k]; });
    if (record == set.records.end())
      table.fail_element("heldout", k, "must be the name of a record");
    else
      record->heldout = true;
  }
  const auto fitted = [](const Record& r) {
    return r.heldout ||
           std::any_of(r.channels.begin(), r.channels.end(), [](const auto& c) { return c.fitted; });
  };
  for (const Record& r : set.records)
    if (!fitted(r))
      table.fail("heldout",
                 fmt::format("must name {}, or its `watched` must leave a column to be fitted", r.name));
  if (!set.records.empty() && set.used(false).empty())
    table.fail("heldout", "must leave a record to be fitted");
  set.tolerance = table.optional_number("model_tolerance", Range::from(0.0, 1.0));
  read_families(table, node, set);
  set.most_effects = table.integer_or("most_effects", set.most_effects, 0, 10);
}

}  // namespace

std::vector<std::size_t> RecordSet::used(bool heldout) const {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < records.size(); ++k)
    if (records[k].heldout == heldout) found.push_back(k);
  return found;
}

bool is_record_file(const std::filesystem::path& file, const std::vector<base::Override>& overrides) {
  TomlNode root = base::parse_toml(file.string(), base::read_text(file, TomlDocument::size_limit));
  std::vector<base::InputProblem> ignored;  // the reader of the file tells them
  for (const base::Override& one : overrides)
    if (one.key == "schema") base::apply_override(root, one, ignored);
  const TomlNode* schema = root.find("schema");
  return schema != nullptr && schema->kind == TomlNode::Kind::text && schema->text == record_schema;
}

RecordSet read_records(const std::filesystem::path& file, const std::vector<base::Override>& overrides) {
  RecordSet set;
  set.file = file;
  std::vector<base::Override> own;
  for (const base::Override& one : overrides) {
    if (one.key.starts_with(to_scenario))
      set.set.push_back({one.key.substr(to_scenario.size()), one.value});
    else
      own.push_back(one);
  }
  TomlNode root_node = base::parse_toml(file.string(), base::read_text(file, TomlDocument::size_limit));
  std::vector<base::InputProblem> problems;
  for (const base::Override& one : own) base::apply_override(root_node, one, problems);
  TomlDocument document(file.string(), root_node);
  for (const base::InputProblem& problem : problems) document.add(problem);
  const TomlTable root = document.root();
  base::require_schema(root, record_schema);
  set.title = root.text("title");
  set.source = root.text_or("source", "");
  const std::filesystem::path folder = file.parent_path();
  const std::string scenario = root.text("scenario");
  set.scenario = folder / scenario;
  if (!scenario.empty() && !std::filesystem::is_regular_file(set.scenario))
    root.fail("scenario", "must be a scenario file beside this one");
  for (base::Override& one : read_set(root, &root_node)) set.set.push_back(std::move(one));
  const TomlNode* list = root_node.find("records");
  const std::vector<TomlTable> tables = root.tables("records");
  for (std::size_t k = 0; k < tables.size(); ++k)
    read_record(tables[k], list != nullptr && k < list->items.size() ? &list->items[k] : nullptr, folder,
                set);
  if (tables.empty()) root.fail("records", "must be given, one table or more");
  read_fit(root.table("fit"), root_node.find("fit"), set);
  document.finish();
  return set;
}

}  // namespace snare::identification
