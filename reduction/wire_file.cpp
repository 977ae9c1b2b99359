#include "reduction/wire_file.hpp"

#include "base/decimal.hpp"
#include "base/toml_reader.hpp"
#include "base/units.hpp"
#include "coupling/statics/spatial_push.hpp"
#include "scenario/motion_reader.hpp"
#include "scenario/push_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace snare::reduction {

namespace {

using base::Range;
using base::TomlDocument;
using base::TomlTable;

using base::mm;
constexpr double proof_strain = 0.002;         // [-]
constexpr double default_low_position = 0.2;   // of the span
constexpr double default_slack_spread = 0.25;  // of the nominal slack, either way
constexpr double shortest_length = 0.99;       // of the span: as read_push_problem asks of the nominal wire
constexpr std::size_t most_values = 16;        // of a listed quantity
constexpr std::size_t most_cases = 256;
constexpr std::size_t most_law_positions = 32;

/// An interval under a key, `[low, high]` or `[value]`, in mm.
std::optional<Interval> read_interval(const TomlTable& table, std::string_view key, Range range) {
  if (!table.has(key)) return std::nullopt;
  const std::vector<double> ends = table.numbers(key, 1, 2, range, mm);
  if (ends.empty()) return std::nullopt;
  if (ends.size() == 2 && ends[1] <= ends[0]) {
    table.fail(key, "must be [low, high] with low < high, or [value]");
    return std::nullopt;
  }
  return Interval{ends.front(), ends.back()};
}

/// The values of one quantity that everything is repeated for; empty: that of the wire.
struct ListedQuantity {
  const char* key;
  Range range;
  double unit;
  void (*set)(coupling::PushProblem&, double);
};

const std::array<ListedQuantity, 4> listed_quantities{{
    {"radius_mm", Range::from(0.0, 100.0), mm,
     [](coupling::PushProblem& t, double v) { t.pusher.radius = v; }},
    {"friction", Range::from(0.0, 2.0), 1.0,
     [](coupling::PushProblem& t, double v) { t.pusher.friction = v; }},
    {"bending_stiffness_Nm2", Range::from(1e-15, 1e9), 1.0,
     [](coupling::PushProblem& t, double v) { t.wire.bending_stiffness_override = v; }},
    {"axial_stiffness_N", Range::above(0.0, 1e15), 1.0,
     [](coupling::PushProblem& t, double v) { t.wire.axial_stiffness_override = v; }},
}};

void read_ranges(const TomlTable& table, WireCase& nominal, bool travel_known) {
  const double span = nominal.test.mount.span;
  const auto in_mm = [](double metres) { return fmt::format("{:.6g}", metres / mm); };
  if (table.has("travel_mm"))
    nominal.travel.high = table.number("travel_mm", Range::from(1e-6, 1000.0), mm);
  else if (travel_known)
    nominal.travel.high = default_travel(nominal.test);

  const bool symmetric = nominal.symmetric();
  nominal.position = {default_low_position * span, (symmetric ? 0.5 : 1.0 - default_low_position) * span};
  if (const auto asked = read_interval(table, "position_mm", Range::above(0.0, 1e5))) {
    nominal.position = *asked;
    for (const double end : {asked->low, asked->high}) {
      if (const auto problem = scenario::position_problem(end, span)) table.fail("position_mm", *problem);
    }
    if (symmetric && asked->low <= 0.5 * span && asked->high > 0.5 * span) {
      // Both halves are the same: the half that reaches farther.
      nominal.position = {std::min(asked->low, span - asked->high), 0.5 * span};
    } else if (symmetric && asked->low > 0.5 * span) {
      nominal.position = {span - asked->high, span - asked->low};
    }
  }
  const double slack = nominal.nominal_slack();
  nominal.slack = {slack, slack};
  if (slack > 0.0)
    nominal.slack = {(1.0 - default_slack_spread) * slack, (1.0 + default_slack_spread) * slack};
  if (const auto asked = read_interval(table, "slack_mm", Range::from(-1e3, 1e5))) {
    nominal.slack = *asked;
    if (base::exceeds(shortest_length * span, span + asked->low))
      table.fail("slack_mm", fmt::format("must be >= {}: a wire at most 1 % shorter than the span of {} mm",
                                         in_mm((shortest_length - 1.0) * span), in_mm(span)));
    const double length = nominal.test.wire.length;
    if (base::exceeds(asked->low, slack, {span, length}) || base::exceeds(slack, asked->high, {span, length}))
      table.fail("slack_mm", fmt::format("must contain that of the wire, {} mm", in_mm(slack)));
  }
}

std::vector<WireCase> combine(const TomlTable& table, const WireCase& nominal) {
  std::vector<WireCase> cases{nominal};
  for (const ListedQuantity& quantity : listed_quantities) {
    if (!table.has(quantity.key)) continue;
    const std::vector<double> values =
        table.numbers(quantity.key, 1, most_values, quantity.range, quantity.unit);
    if (values.empty()) continue;
    std::vector<WireCase> more;
    for (const WireCase& one : cases) {
      for (const double value : values) {
        more.push_back(one);
        quantity.set(more.back().test, value);
      }
    }
    cases = std::move(more);
    if (cases.size() > most_cases) {
      table.fail(quantity.key, fmt::format("gives more than {} combinations", most_cases));
      return {nominal};
    }
  }
  return cases;
}

TablePoints read_points(const TomlTable& table, std::string_view key, TablePoints otherwise, int most) {
  if (!table.has(key)) return otherwise;
  const std::vector<double> values = table.numbers(key, 3, 3, Range::from(2.0, most));
  if (values.size() != 3) return otherwise;
  TablePoints points{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (values[i] != std::floor(values[i])) table.fail_element(key, i, "must be a whole number");
    points[i] = static_cast<int>(values[i]);
  }
  return points;
}

DistilSettings read_settings(const TomlTable& root) {
  DistilSettings settings;
  const TomlTable solver = root.table("solver");
  settings.elements = solver.integer_or("elements", settings.elements, 16, 4096);
  if (settings.elements % 4 != 0) solver.fail("elements", "must be a multiple of 4");
  settings.extrapolate = solver.boolean_or("extrapolate", settings.extrapolate);
  const TomlTable table = root.table("table");
  constexpr int most = 121;
  settings.points = read_points(table, "points", settings.points, most);
  settings.most_points = read_points(table, "most_points", settings.most_points, most);
  for (std::size_t i = 0; i < 3; ++i) {
    if (settings.most_points[i] >= settings.points[i]) continue;
    if (table.has("most_points")) table.fail_element("most_points", i, "must not be less than in points");
    settings.most_points[i] = settings.points[i];
  }
  settings.tolerance = table.number_or("tolerance", settings.tolerance, Range::from(1e-5, 0.5));
  return settings;
}

void read_law_positions(const TomlTable& table, WireCase& nominal) {
  const Interval range = nominal.position;
  if (range.fixed())
    nominal.law_positions = {range.low};
  else
    nominal.law_positions = {range.low, range.middle(), range.high};
  if (!table.has("positions_mm")) return;
  nominal.law_positions = table.numbers("positions_mm", 1, most_law_positions, Range::above(0.0, 1e5), mm);
  for (std::size_t i = 0; i < nominal.law_positions.size(); ++i) {
    if (const auto problem = scenario::position_problem(nominal.law_positions[i], nominal.test.mount.span)) {
      table.fail_element("positions_mm", i, *problem);
    }
  }
}

void read_law_offsets(const TomlTable& table, WireCase& nominal) {
  if (!table.has("displacement_offsets_mm")) return;
  nominal.law_offsets =
      table.numbers("displacement_offsets_mm", 1, most_law_positions, Range::from(0.0, 1000.0), mm);
  if (!nominal.law_offsets.empty() && nominal.law_offsets.size() != nominal.law_positions.size()) {
    table.fail("displacement_offsets_mm",
               fmt::format("must have one value for each of the {} positions", nominal.law_positions.size()));
  }
  for (std::size_t i = 0; i < nominal.law_offsets.size(); ++i) {
    if (nominal.law_offsets[i] >= nominal.travel.high) {
      table.fail_element("displacement_offsets_mm", i,
                         fmt::format("must be < {:.6g}, the end of the travel", nominal.travel.high / mm));
    }
  }
}

/// `[damping]`: impacts on the wire in motion, which is elastic, naturally straight and does not slip in its
/// mounts.
std::optional<ImpactSettings> read_impacts(const TomlTable& root, const scenario::PushTables& tables,
                                           const coupling::PushProblem& nominal) {
  if (!root.has("damping")) return std::nullopt;
  const TomlTable table = root.table("damping");
  ImpactSettings impacts;
  impacts.damping = scenario::read_damping(table);
  impacts.mass = table.number("impact_mass_kg", Range::above(0.0, 1e7));
  impacts.speeds = table.numbers("impact_speeds_m_s", 1, most_values, Range::above(0.0, 100.0));
  impacts.elements = table.integer_or("elements", 60, 8, 20000);
  scenario::require_simple_motion(tables, nominal);
  return impacts;
}

/// Words of C, C++ and Modelica that are no names, as far as they consist of letters.
constexpr std::string_view reserved[] = {
    "algorithm", "alignas", "and",      "asm",      "auto",      "block",   "bool",     "break",
    "case",      "catch",   "char",     "class",    "concept",   "connect", "const",    "constant",
    "continue",  "default", "delete",   "do",       "double",    "each",    "else",     "encapsulated",
    "end",       "enum",    "equation", "explicit", "export",    "extends", "extern",   "external",
    "false",     "final",   "float",    "flow",     "for",       "friend",  "function", "goto",
    "if",        "import",  "in",       "initial",  "inline",    "inner",   "input",    "int",
    "long",      "loop",    "model",    "mutable",  "namespace", "new",     "not",      "operator",
    "or",        "outer",   "output",   "package",  "parameter", "partial", "private",  "protected",
    "public",    "record",  "register", "requires", "restrict",  "return",  "short",    "signed",
    "sizeof",    "static",  "std",      "stream",   "struct",    "switch",  "template", "then",
    "this",      "throw",   "true",     "try",      "type",      "typedef", "typename", "union",
    "unsigned",  "using",   "virtual",  "void",     "volatile",  "when",    "while",    "within",
    "xor"};

std::string read_export_name(const TomlTable& table) {
  std::string name = table.text_or("name", "");
  if (name.empty()) return name;
  constexpr std::size_t longest = 40;
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const bool identifier =
      letter(name.front()) && name.size() <= longest &&
      std::ranges::all_of(name, [&](char c) { return letter(c) || c == '_' || (c >= '0' && c <= '9'); });
  if (!identifier)
    table.fail("name", fmt::format("must be a letter and letters, digits or low lines behind it, {} at most",
                                   longest));
  else if (std::ranges::find(reserved, name) != std::end(reserved))
    table.fail("name", "must be no word of C, C++ or Modelica itself");
  return name;
}

WireFile read_document(TomlDocument& document, const std::filesystem::path& file) {
  const TomlTable root = document.root();
  base::require_schema(root, "snare-wire/1");
  WireFile result;
  result.file = file;
  result.title = root.text_or("title", "");
  result.source = root.text_or("source", "");
  result.settings = read_settings(root);
  const scenario::PushTables tables = scenario::push_tables(root);
  WireCase nominal;
  nominal.test = scenario::read_push_problem(tables);
  if (coupling::needs_space(nominal.test)) {
    (nominal.test.pusher.tilt != 0.0 ? tables.pusher : tables.gravity)
        .fail(nominal.test.pusher.tilt != 0.0 ? "tilt_deg" : "vector_m_s2",
              "must keep the push in the plane of the wire: only such pushes are distilled");
  }
  const bool numbers_known =
      std::isfinite(nominal.test.wire.length) && std::isfinite(nominal.test.mount.span);
  const TomlTable ranges = root.table("ranges");
  read_ranges(ranges, nominal, numbers_known);
  read_law_positions(root.table("laws"), nominal);
  read_law_offsets(root.table("laws"), nominal);
  result.cases = combine(ranges, nominal);
  result.impacts = read_impacts(root, tables, nominal.test);
  result.export_name = read_export_name(root.table("exports"));
  document.finish();
  return result;
}

}  // namespace

bool WireCase::symmetric() const noexcept {
  return test.pusher.misalignment == 0.0 && !test.mount.slip_tension && test.gravity[0] == 0.0 &&
         test.bulge.mode % 2 == 1 && test.wire.bending_profile.empty();
}

bool WireCase::dissipates() const noexcept {
  return test.pusher.friction > 0.0 || test.mount.slip_tension || test.wire.yielding ||
         test.wire.strand_friction;
}

double default_travel(const coupling::PushProblem& test) {
  const double span = test.mount.span;
  const double slack = test.wire.length - span;
  // Height of two straight pieces of a wire of this length, and of the shallow buckled shape (the first mode:
  // its shortening is pi^2 h^2/(4 span) between clamps and between pins).
  const auto taut = [&](double length) {
    return 0.5 * std::sqrt(std::max(0.0, length * length - span * span));
  };
  const double bulge = 2.0 / std::numbers::pi * std::sqrt(span * std::max(0.0, slack));
  const double stretched = taut((1.0 + proof_strain) * std::max(test.wire.length, span));
  const bool inward = test.pusher.direction == coupling::PushDirection::inward;
  // Against the bulge: down to three quarters of its height, which is before it snaps through.
  return inward && slack > 0.0 ? 0.25 * bulge : std::max(stretched - bulge, 0.01 * span);
}

WireFile read_wire_file(const std::filesystem::path& file, const std::vector<base::Override>& overrides) {
  TomlDocument document(file, overrides);
  return read_document(document, file);
}

WireFile parse_wire_file(const std::filesystem::path& file, std::string_view text,
                         const std::vector<base::Override>& overrides) {
  TomlDocument document(file.string(), text, overrides);
  return read_document(document, file);
}

}  // namespace snare::reduction
