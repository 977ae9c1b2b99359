#include "identification/fitting/experiment.hpp"

#include "base/csv.hpp"
#include "base/files.hpp"
#include "base/toml_reader.hpp"
#include "base/units.hpp"
#include "identification/fitting/parameter_set.hpp"
#include "identification/fitting/unfitted_keys.hpp"
#include "scenario/push_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace snare::identification {

namespace {

using base::CsvColumn;
using base::InputError;
using base::InputProblem;
using base::Range;
using base::TomlDocument;
using base::TomlTable;

constexpr std::string_view schema = "snare-experiment/1";

using base::mm;

// Upper bounds keep slips of the unit out (a length in um, a modulus in Pa) and every product finite.
constexpr double largest_length = 1e5;        // [mm]
constexpr double largest_travel = 1000.0;     // [mm]
constexpr double largest_force = 1e9;         // [N]
constexpr double largest_place_error = 10.0;  // [mm]
constexpr int most_points = 1'000'000;
constexpr std::size_t most_travels = 10'000'000;  // points of a path
constexpr int default_law_points = 20;
constexpr int fewest_law_points = 4;  // one more than the fit has numbers
constexpr std::size_t fewest_rows = 3;

/// The tables of one series above those of the file.
scenario::PushTables over(const scenario::PushTables& own, const scenario::PushTables& base) {
  return {own.wire.over(base.wire), own.mount.over(base.mount), own.pusher.over(base.pusher),
          own.bulge.over(base.bulge), own.gravity.over(base.gravity)};
}

double read_contact_position(const TomlTable& series, double span) {
  const double position = series.number("contact_position_mm", Range::above(0.0, largest_length), mm);
  if (!std::isfinite(position) || !std::isfinite(span)) return position;  // reported already
  if (const auto problem = scenario::position_problem(position, span))
    series.fail("contact_position_mm", *problem);
  return position;
}

/// `points` values from `from` to `to`, both included, evenly spread; the first is left out where `skip` is
/// 1.
void append_leg(std::vector<double>& travel, double from, double to, int points, int skip) {
  const double step = (to - from) / (points - 1);
  for (int i = skip; i < points - 1; ++i) travel.push_back(from + i * step);
  travel.push_back(to);
}

std::vector<double> read_travel(const TomlTable& series) {
  const double travel = series.number("travel_mm", Range::above(0.0, largest_travel), mm);
  const int points = series.integer("points", 2, most_points);
  std::vector<double> result;
  append_leg(result, 0.0, travel, points, 0);
  return result;
}

std::vector<double> read_path(const TomlTable& series) {
  constexpr std::size_t most_turns = 10000;
  const std::vector<double> turns =
      series.numbers("path_mm", 2, most_turns, Range::from(-largest_travel, largest_travel), mm);
  const int points = series.integer("points", 2, most_points);
  if (turns.empty()) return {};
  if (std::adjacent_find(turns.begin(), turns.end()) != turns.end())
    series.fail("path_mm", "neighbouring turning points must differ");
  const std::size_t total = (turns.size() - 1) * static_cast<std::size_t>(points - 1) + 1;
  if (total > most_travels) {
    series.fail("points",
                fmt::format("gives {} points on the path, must give at most {}", total, most_travels));
    return {};
  }
  std::vector<double> result;
  result.reserve(total);
  for (std::size_t leg = 0; leg + 1 < turns.size(); ++leg)
    append_leg(result, turns[leg], turns[leg + 1], points, leg == 0 ? 0 : 1);
  return result;
}

constexpr int most_decimals = 15;

/// Decimals of the shortest notation of a number.
int decimals_of(double number) {
  for (int digits = 0; digits < most_decimals; ++digits) {
    const double unit = std::pow(10.0, digits);
    if (std::round(number * unit) / unit == number) return digits;
  }
  return most_decimals;
}

QuadraticLaw read_law(const TomlTable& table) {
  const Range coefficient = Range::from(-1e12, 1e12);
  QuadraticLaw law;
  law.a = table.number("A_N_m2", coefficient);
  law.b = table.number("B_N_m", coefficient);
  law.c = table.number("C_N", coefficient);
  law.r_squared = table.number("R2", Range::above(0.0, 1.0));
  law.to = table.number("to_mm", Range::above(0.0, largest_travel), mm);
  law.r_squared_digits = table.integer_or(
      "R2_digits", std::max(QuadraticLaw::default_r_squared_digits, decimals_of(law.r_squared)), 1,
      most_decimals);
  return law;
}

constexpr double largest_scale = 1e12;

/// Entries of a table whose keys the user chose; null where there is none. node: of the table above it.
const std::vector<base::TomlEntry>* entries_of(const base::TomlNode* node, const char* key) {
  const base::TomlNode* found = node == nullptr ? nullptr : node->find(key);
  return found != nullptr && found->kind == base::TomlNode::Kind::table ? &found->entries : nullptr;
}

/// Puts the names that `columns = { "CSV column" = "force_N" }` gives to the columns that are looked for.
void rename_columns(const TomlTable& series, const base::TomlNode* node, std::vector<CsvColumn>& columns) {
  if (!series.has("columns")) return;
  const auto* entries = entries_of(node, "columns");
  if (entries == nullptr || entries->empty()) {
    series.fail("columns", "must be a table of columns and what they are: { \"Load\" = \"force_N\" }");
    return;
  }
  const TomlTable named = series.table("columns");
  std::set<std::string> taken;
  for (const base::TomlEntry& entry : *entries) {
    const std::string meaning = named.text(entry.key);
    if (meaning.empty()) continue;  // reported
    const auto is = [](const std::string& name) {
      return [&name](const CsvColumn& c) { return c.meaning == name; };
    };
    const auto found = std::ranges::find_if(columns, is(meaning));
    if (found == columns.end()) {
      const bool turned = std::ranges::any_of(columns, is(entry.key));
      named.fail(entry.key,
                 turned ? fmt::format("stands the wrong way round: {{ \"{}\" = \"{}\" }}", meaning, entry.key)
                        : "must be \"displacement_mm\", \"force_N\" or \"time_s\"");
    } else if (!taken.insert(meaning).second) {
      named.fail(entry.key, fmt::format("another column is {} already", meaning));
    } else {
      found->name = entry.key;
      found->presence = CsvColumn::Presence::required;
    }
  }
}

/// Factors of `scale = { "CSV column" = 1000.0 }`, from the file's unit to that of the column's meaning;
/// negative ones turn the sign.
void scale_columns(const TomlTable& series, const base::TomlNode* node, std::vector<CsvColumn>& columns) {
  if (!series.has("scale")) return;
  const auto* entries = entries_of(node, "scale");
  if (entries == nullptr || entries->empty()) {
    series.fail("scale", "must be a table of columns and factors: { \"Load\" = 1000.0 }");
    return;
  }
  const TomlTable factors = series.table("scale");
  for (const base::TomlEntry& entry : *entries) {
    const double factor = factors.number(entry.key, Range::from(-largest_scale, largest_scale));
    const auto found = std::ranges::find(columns, entry.key, &CsvColumn::name);
    if (found == columns.end()) {
      factors.fail(entry.key, fmt::format("must be a column that is read: {}, {} or {}", columns[0].name,
                                          columns[1].name, columns[2].name));
    } else if (!(std::abs(factor) >= 1.0 / largest_scale) || (factor < 0.0 && found->meaning == "time_s")) {
      if (std::isfinite(factor))
        factors.fail(entry.key, found->meaning == "time_s" ? "must be > 0" : "must not be 0");
    } else {
      found->scaled = true;
      found->unit *= factor;
      found->range = Range::from(found->range.low / std::abs(factor), found->range.high / std::abs(factor));
    }
  }
}

/// Columns of the readings of a push, under the names and with the factors of the series.
std::vector<CsvColumn> columns_of_readings(const TomlTable& series, const base::TomlNode* node) {
  std::vector<CsvColumn> columns{
      {"displacement_mm", CsvColumn::Presence::required, Range::from(-largest_travel, largest_travel), mm},
      {"force_N", CsvColumn::Presence::required, Range::from(-largest_force, largest_force)},
      {"time_s", CsvColumn::Presence::optional, Range::from(-1e12, 1e12), 1.0,
       CsvColumn::Order::non_decreasing}};
  for (CsvColumn& column : columns) column.meaning = column.name;
  rename_columns(series, node, columns);
  scale_columns(series, node, columns);
  return columns;
}

/// Reads the CSV file of a series. What is wrong inside it is reported at its line; what is wrong with it as
/// a whole, at the key that names it.
std::optional<Readings> read_readings(TomlDocument& document, const TomlTable& series,
                                      const base::TomlNode* node, const std::filesystem::path& folder) {
  const std::vector<CsvColumn> columns = columns_of_readings(series, node);
  const std::string name = series.text("file");
  if (name.empty()) {
    series.fail("file", "must be the name of a CSV file");
    return std::nullopt;
  }
  const std::filesystem::path path = folder / name;
  const auto fail = [&](const std::string& requirement) {
    series.fail("file", fmt::format("{}: {}", path.string(), requirement));
  };
  try {
    base::CsvTable table = base::read_csv(path, columns);
    Readings readings{std::move(table.columns[0]), std::move(table.columns[1]), std::move(table.columns[2])};
    const std::vector<double>& moved = readings.displacement;
    if (table.rows < fewest_rows)
      fail(fmt::format("has {} rows, must have at least {}", table.rows, fewest_rows));
    else if (std::all_of(moved.begin(), moved.end(), [&](double one) { return one == moved.front(); }))
      fail("displacement_mm is the same in every row");
    return readings;
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) {
      if (problem.line == 0)
        fail(problem.requirement);
      else
        document.add(problem);
    }
    return std::nullopt;
  }
}

/// What stands for the push of a series: readings, a law, or a prediction's travel.
enum class Source { none, file, law, travel, path };

Source read_source(const TomlTable& table) {
  static constexpr std::pair<const char*, Source> sources[] = {
      {"file", Source::file}, {"law", Source::law}, {"travel_mm", Source::travel}, {"path_mm", Source::path}};
  Source source = Source::none;
  const char* first = nullptr;
  for (const auto& [key, value] : sources) {
    if (!table.has(key)) continue;
    if (first != nullptr) {
      table.fail(key, fmt::format("cannot stand beside {}", first));
    } else {
      first = key;
      source = value;
    }
  }
  if (first == nullptr)
    table.fail("", "must have one of: file, law, travel_mm with points, path_mm with points");
  if (source == Source::file && table.has("points")) table.fail("points", "cannot stand beside file");
  for (const char* key : {"columns", "scale"})
    if (source != Source::file && table.has(key)) table.fail(key, "only with file");
  return source;
}

std::string read_name(const TomlTable& table) {
  constexpr std::size_t longest = 64;
  std::string name = table.text("name");
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  const bool safe = !name.empty() && name.size() <= longest && std::all_of(name.begin(), name.end(), fits) &&
                    name.front() != '.' && name.front() != '-';
  if (table.has("name") && !safe)
    table.fail(
        "name",
        fmt::format("must be 1 to {} letters, digits, '_', '-' or '.', the first a letter, digit or '_'",
                    longest));
  return name;
}

Series read_series(TomlDocument& document, const TomlTable& table, const base::TomlNode* node,
                   const scenario::PushTables& base, const std::filesystem::path& folder) {
  const scenario::PushTables tables = over(scenario::push_tables(table), base);
  Series series;
  series.name = read_name(table);
  series.test = scenario::read_push_problem(tables);
  series.test.contact_position = read_contact_position(table, series.test.mount.span);
  series.modulus_declared = tables.wire.has("youngs_modulus_GPa");
  series.force_sigma = table.optional_number("force_sigma_N", Range::above(0.0, largest_force));
  series.position_sigma =
      base::mm * table.number_or("contact_position_sigma_mm", 0.0, Range::from(0.0, largest_place_error));
  static_cast<void>(table.has("points"));
  switch (read_source(table)) {
    case Source::none:
      break;
    case Source::travel:
      series.test.travel = read_travel(table);
      break;
    case Source::path:
      series.test.travel = read_path(table);
      break;
    case Source::law: {
      series.law = read_law(table.table("law"));
      const int points = table.integer_or("points", default_law_points, fewest_law_points, most_points);
      append_leg(series.test.travel, 0.0, series.law->to, points, 0);
      break;
    }
    case Source::file:
      series.readings = read_readings(document, table, node, folder);
      if (series.readings) series.test.travel = series.readings->displacement;
      break;
  }
  return series;
}

void check_names(const std::vector<Series>& series, const std::vector<TomlTable>& tables) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < series.size(); ++i)
    if (!series[i].name.empty() && !names.insert(series[i].name).second)
      tables[i].fail("name", "another series has this name");
}

SolverSettings read_solver(const TomlTable& table) {
  SolverSettings solver;
  solver.elements = table.integer_or("elements", solver.elements, 16, 100'000);
  if (solver.elements % 4 != 0) table.fail("elements", "must be a multiple of 4");
  solver.extrapolate = table.boolean_or("extrapolate", solver.extrapolate);
  constexpr base::Choice<coupling::Instability> branches[]{
      {"follow_path", coupling::Instability::follow_path},
      {"switch_branch", coupling::Instability::switch_branch}};
  if (table.has("instability")) {
    solver.instability = table.choice("instability", branches).value_or(solver.instability);
  }
  return solver;
}

/// Elements of an array of names that must come from a list, each once.
std::vector<std::string> read_names(const TomlTable& table, std::string_view key,
                                    const std::vector<std::string>& known, std::string_view what) {
  std::vector<std::string> names = table.texts_or_none(key);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(known.begin(), known.end(), names[i]) == known.end()) {
      if (const std::string why = why_not_fitted(names[i]); key != "heldout" && !why.empty()) {
        table.fail_element(key, i, fmt::format("must be {}: {}", what, why));
        continue;
      }
      const std::string nearest = base::nearest_word(names[i], known);
      table.fail_element(key, i,
                         nearest.empty() ? fmt::format("must be {}", what)
                                         : fmt::format("must be {}; did you mean {}?", what, nearest));
    } else if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
               names.begin() + static_cast<std::ptrdiff_t>(i)) {
      table.fail_element(key, i, "is there twice");
    }
  }
  return names;
}

/// A number of its own for every series: series[NAME].KEY instead of KEY.
void add_per_series(const TomlTable& fit, const std::vector<std::string>& keys,
                    const std::vector<std::string>& names, std::vector<std::string>& free) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (std::find(free.begin(), free.end(), keys[i]) != free.end()) {
      fit.fail_element("per_series", i,
                       "is in free, too: it cannot be one number for all series and one for each");
      continue;
    }
    for (const std::string& name : names) {
      std::string own = fmt::format("series[{}].{}", name, keys[i]);
      if (std::find(free.begin(), free.end(), own) == free.end()) free.push_back(std::move(own));
    }
  }
}

/// How far the sensors of the machine went, in all series together.
void note_largest_readings(std::vector<Series>& series) {
  double displacement = 0.0, force = 0.0;
  for (const Series& s : series) {
    if (!s.readings) continue;
    for (const double d : s.readings->displacement) displacement = std::max(displacement, std::abs(d));
    for (const double f : s.readings->force) force = std::max(force, std::abs(f));
  }
  for (Series& s : series) {
    s.largest_displacement = displacement;
    s.largest_force = force;
  }
}

/// root_node: the tree of the document, for tables whose keys the user chose.
Experiment read_document(TomlDocument& document, const base::TomlNode& root_node,
                         const std::filesystem::path& file, const ParameterSet& parameters) {
  const TomlTable root = document.root();
  base::require_schema(root, schema);

  Experiment experiment;
  experiment.file = file;
  experiment.title = root.text_or("title", "");
  experiment.source = root.text_or("source", "");
  experiment.solver = read_solver(root.table("solver"));

  const scenario::PushTables base = scenario::push_tables(root);
  const std::vector<TomlTable> tables = root.tables("series");
  const base::TomlNode* list = root_node.find("series");
  std::vector<std::string> names;
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const base::TomlNode* node = list != nullptr && k < list->items.size() ? &list->items[k] : nullptr;
    experiment.series.push_back(read_series(document, tables[k], node, base, file.parent_path()));
    names.push_back(experiment.series.back().name);
  }
  check_names(experiment.series, tables);
  note_largest_readings(experiment.series);
  if (!root.has("series")) root.fail("series", "missing, must be one or more tables, each headed [[series]]");
  if (tables.empty()) static_cast<void>(scenario::read_push_problem(base));  // what else is wrong

  const TomlTable fit = root.table("fit");
  std::vector<std::string> keys = parameters.keys();
  for (const std::string& name : names) {
    for (const std::string& key : parameters.keys()) keys.push_back(fmt::format("series[{}].{}", name, key));
  }
  experiment.free = read_names(fit, "free", keys, "a number that can be fitted");
  add_per_series(fit, read_names(fit, "per_series", parameters.keys(), "a number that can be fitted"), names,
                 experiment.free);
  experiment.model_tolerance = fit.optional_number("model_tolerance", Range::from(0.0, 0.5));
  constexpr base::Choice<PublishedScatter> scatters[]{{"common", PublishedScatter::common},
                                                      {"each", PublishedScatter::each}};
  if (fit.has("published_scatter")) {
    experiment.published_scatter =
        fit.choice("published_scatter", scatters).value_or(experiment.published_scatter);
  }
  experiment.heldout = read_names(fit, "heldout", names, "the name of a series");
  const std::set<std::string> distinct(experiment.heldout.begin(), experiment.heldout.end());
  if (!names.empty() && distinct.size() >= names.size())
    fit.fail("heldout", "must leave at least one series to fit");
  document.finish();
  return experiment;
}

}  // namespace

double QuadraticLaw::scatter() const {
  // With u = d / to uniform on [0, 1], p = A to^2 and q = B to, the law is p u^2 + q u + C and its variance
  //   p^2 (1/5 - 1/9) + 2 p q (1/4 - 1/6) + q^2 (1/3 - 1/4) = 4 p^2 / 45 + p q / 6 + q^2 / 12.
  // R^2 = 1 - S_residual / (S_law + S_residual), hence S_residual / S_law = (1 - R^2) / R^2.
  const double p = a * to * to;
  const double q = b * to;
  const double variance = 4.0 * p * p / 45.0 + p * q / 6.0 + q * q / 12.0;
  return std::sqrt((1.0 - r_squared) / r_squared * std::max(variance, 0.0));
}

Experiment read_experiment(const std::filesystem::path& file, const ParameterSet& parameters,
                           const std::vector<Override>& overrides) {
  return parse_experiment(file, base::read_text(file, TomlDocument::size_limit), parameters, overrides);
}

Experiment parse_experiment(const std::filesystem::path& file, std::string_view text,
                            const ParameterSet& parameters, const std::vector<Override>& overrides) {
  base::TomlNode root = base::parse_toml(file.string(), text);
  TomlDocument document(file.string(), root, overrides);
  std::vector<InputProblem> reported;  // by the document
  for (const Override& one : overrides) base::apply_override(root, one, reported);
  return read_document(document, root, file, parameters);
}

}  // namespace snare::identification
