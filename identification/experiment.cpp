#include "identification/experiment.hpp"

#include "identification/parameter.hpp"
#include "numerics/csv.hpp"
#include "numerics/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace snare::identification {

namespace {

using numerics::Choice;
using numerics::CsvColumn;
using numerics::InputError;
using numerics::InputProblem;
using numerics::Range;
using numerics::TomlDocument;
using numerics::TomlTable;

constexpr std::string_view schema = "snare-experiment/1";

constexpr double mm = 1e-3;                          // [m]
constexpr double GPa = 1e9;                          // [Pa]
constexpr double degree = std::numbers::pi / 180.0;  // [rad]

// Upper bounds keep slips of the unit out (a length in um, a modulus in Pa) and every product finite.
constexpr double largest_length = 1e5;                // [mm]
constexpr double largest_travel = 1000.0;             // [mm]
constexpr double largest_force = 1e9;                 // [N]
constexpr double largest_stiffness = 1e15;            // [N/m], [N m/rad], [N]
constexpr double smallest_bending_stiffness = 1e-15;  // [N m^2]; a glass fibre of 10 um has 3e-11
constexpr double shortest_length = 0.99;              // of the span, between clamps or pins
constexpr double mount_margin = 0.01;                 // of the span, between contact and mount
constexpr double thickest_wire = 0.2;                 // of the span
constexpr int most_points = 1'000'000;
constexpr std::size_t most_travels = 10'000'000;  // points of a path
constexpr int default_law_points = 41;
constexpr std::size_t fewest_rows = 3;

/// Numbers that a fit may change.
std::vector<std::string> free_keys() {
  std::vector<std::string> keys;
  for (const Parameter& p : all_parameters()) keys.push_back(p.key);
  return keys;
}

/// Length for a message, in mm without rounding noise.
std::string in_mm(double metres) {
  return fmt::format("{:.6g}", metres / mm);
}

/// The tables that describe one push: those of the file under those of one series.
struct TestTables {
  TomlTable wire, mount, pusher, bulge, gravity;
};

TestTables tables_of(const TomlTable& root) {
  return {root.table("wire"), root.table("mount"), root.table("pusher"), root.table("bulge"),
          root.table("gravity")};
}

TestTables over(const TestTables& own, const TestTables& base) {
  return {own.wire.over(base.wire), own.mount.over(base.mount), own.pusher.over(base.pusher),
          own.bulge.over(base.bulge), own.gravity.over(base.gravity)};
}

wire::WireSpecification read_wire(const TomlTable& table) {
  static constexpr Choice<wire::Construction> constructions[] = {{"solid", wire::Construction::solid},
                                                                 {"strand", wire::Construction::strand}};
  wire::WireSpecification wire;
  wire.construction = table.choice("construction", constructions).value_or(wire.construction);
  wire.diameter = table.number("diameter_mm", Range::above(0.0, 100.0), mm);
  wire.length = table.number("length_mm", Range::above(0.0, largest_length), mm);
  wire.youngs_modulus = table.number("youngs_modulus_GPa", Range::above(0.0, 1e4), GPa);
  wire.poisson_ratio = table.number("poisson_ratio", Range::above(-1.0, 0.5));
  wire.density = table.number("density_kg_m3", Range::above(0.0, 1e5));
  const Range bending = Range::from(smallest_bending_stiffness, 1e9);
  wire.bending_stiffness_override = table.optional_number("bending_stiffness_Nm2", bending);
  wire.axial_stiffness_override =
      table.optional_number("axial_stiffness_N", Range::above(0.0, largest_stiffness));
  wire.torsional_stiffness_override = table.optional_number("torsional_stiffness_Nm2", bending);
  wire.natural_curvature = table.number_or("natural_curvature_1_m", 0.0, Range::from(-1e4, 1e4));
  if (const auto stress = table.optional_number("yield_stress_MPa", Range::from(1.0, 1e5))) {
    wire::Yielding yielding;
    yielding.yield_stress = 1e6 * *stress;
    yielding.hardening_ratio = table.number_or("hardening_ratio", wire::Yielding::usual_hardening, Range::from(0.002, 0.9));
    wire.yielding = yielding;
  } else if (table.has("hardening_ratio")) {
    table.fail("hardening_ratio", "only beside yield_stress_MPa");
  }
  const auto extra = table.optional_number("strand_extra_stiffness_Nm2", bending);
  const auto slip = table.optional_number("strand_slip_curvature_1_m", Range::from(1e-4, 1e4));
  if (extra && slip) wire.strand_friction = wire::StrandFriction{*extra, *slip};
  else if (extra) table.fail("strand_extra_stiffness_Nm2", "needs strand_slip_curvature_1_m beside it");
  else if (slip) table.fail("strand_slip_curvature_1_m", "needs strand_extra_stiffness_Nm2 beside it");
  if (wire.bending_stiffness() < smallest_bending_stiffness)
    table.fail("diameter_mm", fmt::format("gives a bending stiffness of {:.3g} N m^2, must be >= {}",
                                          wire.bending_stiffness(), smallest_bending_stiffness));
  return wire;
}

wire::MountSpecification read_mount(const TomlTable& table) {
  static constexpr Choice<wire::MountKind> kinds[] = {{"clamped", wire::MountKind::clamped},
                                                      {"pinned", wire::MountKind::pinned},
                                                      {"supports", wire::MountKind::supports}};
  const Range stiffness = Range::above(0.0, largest_stiffness);
  wire::MountSpecification mount;
  const std::optional<wire::MountKind> kind = table.choice("kind", kinds);
  mount.kind = kind.value_or(mount.kind);
  mount.span = table.number("span_mm", Range::above(0.0, largest_length), mm);
  const Range radius = Range::from(0.0, 1000.0);
  if (kind == wire::MountKind::supports)
    mount.support_radius = table.number("support_radius_mm", radius, mm);
  else
    mount.support_radius = table.number_or("support_radius_mm", 0.0, radius, mm);
  mount.translational_stiffness = table.optional_number("translational_stiffness_N_m", stiffness);
  mount.rotational_stiffness = table.optional_number("rotational_stiffness_Nm_rad", stiffness);
  mount.slip_tension = table.optional_number("slip_tension_N", Range::above(0.0, largest_force));

  const auto refuse = [&](std::string_view key, std::string_view kinds_that_have_it) {
    if (table.has(key)) table.fail(key, fmt::format("only for a mount of kind {}", kinds_that_have_it));
  };
  if (!kind) return mount;
  if (*kind != wire::MountKind::supports) refuse("support_radius_mm", "\"supports\"");
  if (*kind != wire::MountKind::clamped) refuse("rotational_stiffness_Nm_rad", "\"clamped\"");
  if (*kind == wire::MountKind::supports) {
    refuse("translational_stiffness_N_m", "\"clamped\" or \"pinned\"");
    refuse("slip_tension_N", "\"clamped\" or \"pinned\"");
  }
  return mount;
}

coupling::PusherSpecification read_pusher(const TomlTable& table) {
  static constexpr Choice<bool> shapes[] = {{"cylinder", true}};  // the only one; a knife edge has radius 0
  static constexpr Choice<coupling::PushDirection> directions[] = {
      {"outward", coupling::PushDirection::outward}, {"inward", coupling::PushDirection::inward}};
  coupling::PusherSpecification pusher;
  static_cast<void>(table.choice("shape", shapes));
  pusher.radius = table.number("radius_mm", Range::from(0.0, 100.0), mm);
  pusher.friction = table.number("friction", Range::from(0.0, 2.0));
  pusher.direction = table.choice("direction", directions).value_or(pusher.direction);
  pusher.compliance = table.number_or("compliance_m_N", 0.0, Range::from(0.0, 1e-3));
  pusher.tilt = table.number_or("tilt_deg", 0.0, Range::from(-45.0, 45.0), degree);
  pusher.misalignment = table.number_or("misalignment_deg", 0.0, Range::from(-45.0, 45.0), degree);
  return pusher;
}

coupling::BulgeSpecification read_bulge(const TomlTable& table) {
  coupling::BulgeSpecification bulge;
  bulge.mode = table.integer_or("mode", bulge.mode, 1, 4);
  bulge.plane = table.number_or("plane_deg", 0.0, Range::from(-90.0, 90.0), degree);
  return bulge;
}

std::array<double, 3> read_gravity(const TomlTable& table) {
  if (!table.has("vector_m_s2")) return {0.0, 0.0, 0.0};
  const std::vector<double> values = table.numbers("vector_m_s2", 3, 3, Range::from(-1000.0, 1000.0));
  if (values.size() != 3) return {0.0, 0.0, 0.0};
  return {values[0], values[1], values[2]};
}

/// What no key can say alone. A number that was refused is NaN, and no comparison with it holds.
void check_wire_between_mounts(const coupling::PushTest& test, const TestTables& tables) {
  const double span = test.mount.span;
  const bool rests = test.mount.kind == wire::MountKind::supports;
  const double shortest = (rests ? 1.0 : shortest_length) * span;
  if (test.wire.length < shortest)
    tables.wire.fail("length_mm", rests ? fmt::format("must be >= {}, the span of the supports", in_mm(span))
                                        : fmt::format("must be >= {}, {:g} % of the span of {} mm",
                                                      in_mm(shortest), 100.0 * shortest_length, in_mm(span)));
  if (test.wire.diameter >= thickest_wire * span)
    tables.wire.fail("diameter_mm", fmt::format("must be < {}, a fifth of the span of {} mm",
                                                in_mm(thickest_wire * span), in_mm(span)));
}

coupling::PushTest read_test(const TestTables& tables) {
  coupling::PushTest test;
  test.wire = read_wire(tables.wire);
  test.mount = read_mount(tables.mount);
  test.pusher = read_pusher(tables.pusher);
  test.bulge = read_bulge(tables.bulge);
  test.gravity = read_gravity(tables.gravity);
  check_wire_between_mounts(test, tables);
  return test;
}

double read_contact_position(const TomlTable& series, double span) {
  const double position = series.number("contact_position_mm", Range::above(0.0, largest_length), mm);
  const double margin = mount_margin * span;
  if (position < margin || position > span - margin)
    series.fail("contact_position_mm",
                fmt::format("must be >= {} and <= {}: inside the span of {} mm, {:g} % of it from each mount",
                            in_mm(margin), in_mm(span - margin), in_mm(span), 100.0 * mount_margin));
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

QuadraticLaw read_law(const TomlTable& table) {
  const Range coefficient = Range::from(-1e12, 1e12);
  QuadraticLaw law;
  law.a = table.number("A_N_m2", coefficient);
  law.b = table.number("B_N_m", coefficient);
  law.c = table.number("C_N", coefficient);
  law.r_squared = table.number("R2", Range::above(0.0, 1.0));
  law.to = table.number("to_mm", Range::above(0.0, largest_travel), mm);
  return law;
}

/// Reads the CSV file of a series. What is wrong inside it is reported at its line; what is wrong with it as
/// a whole, at the key that names it.
std::optional<Readings> read_readings(TomlDocument& document, const TomlTable& series,
                                      const std::filesystem::path& folder) {
  const std::vector<CsvColumn> columns{
      {"displacement_mm", CsvColumn::Presence::required, Range::from(-largest_travel, largest_travel), mm},
      {"force_N", CsvColumn::Presence::required, Range::from(-largest_force, largest_force)},
      {"time_s", CsvColumn::Presence::optional, Range::from(-1e12, 1e12), 1.0,
       CsvColumn::Order::non_decreasing}};
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
    numerics::CsvTable table = numerics::read_csv(path, columns);
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
  return source;
}

std::string read_name(const TomlTable& table) {
  constexpr std::size_t longest = 64;
  const std::string name = table.text("name");
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

Series read_series(TomlDocument& document, const TomlTable& table, const TestTables& base,
                   const std::filesystem::path& folder) {
  const TestTables tables = over(tables_of(table), base);
  Series series;
  series.name = read_name(table);
  series.test = read_test(tables);
  series.test.contact_position = read_contact_position(table, series.test.mount.span);
  series.force_sigma = table.optional_number("force_sigma_N", Range::above(0.0, largest_force));
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
      const int points = table.integer_or("points", default_law_points, 2, most_points);
      append_leg(series.test.travel, 0.0, series.law->to, points, 0);
      break;
    }
    case Source::file:
      series.readings = read_readings(document, table, folder);
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
  constexpr numerics::Choice<coupling::Instability> branches[]{
      {"follow_path", coupling::Instability::follow_path}, {"switch_branch", coupling::Instability::switch_branch}};
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
      const std::string nearest = numerics::nearest_word(names[i], known);
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

Experiment read_document(TomlDocument& document, const std::filesystem::path& file) {
  const TomlTable root = document.root();
  static constexpr Choice<bool> schemas[] = {{schema, true}};
  static_cast<void>(root.choice("schema", schemas));

  Experiment experiment;
  experiment.file = file;
  experiment.title = root.text_or("title", "");
  experiment.source = root.text_or("source", "");
  experiment.solver = read_solver(root.table("solver"));

  const TestTables base = tables_of(root);
  const std::vector<TomlTable> tables = root.tables("series");
  std::vector<std::string> names;
  for (const TomlTable& table : tables) {
    experiment.series.push_back(read_series(document, table, base, file.parent_path()));
    names.push_back(experiment.series.back().name);
  }
  check_names(experiment.series, tables);
  if (!root.has("series")) root.fail("series", "missing, must be one or more tables, each headed [[series]]");
  if (tables.empty()) static_cast<void>(read_test(base));  // what else is wrong

  const TomlTable fit = root.table("fit");
  std::vector<std::string> keys = free_keys();
  for (const std::string& name : names) {
    for (const Parameter& p : all_parameters()) keys.push_back("series[" + name + "]." + p.key);
  }
  experiment.free = read_names(fit, "free", keys, "a number that can be fitted");
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

Experiment read_experiment(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  TomlDocument document(file, overrides);
  return read_document(document, file);
}

Experiment parse_experiment(const std::filesystem::path& file, std::string_view text,
                            const std::vector<Override>& overrides) {
  TomlDocument document(file.string(), text, overrides);
  return read_document(document, file);
}

}  // namespace snare::identification
