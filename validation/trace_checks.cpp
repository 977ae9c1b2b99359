#include "validation/trace_checks.hpp"

#include "identification/effects/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace snare::validation {

bool is_right_outside(const BlindSet& set, const identification::Trace& trace) {
  if (trace.selected.empty()) return !trace.explained;
  return set.effect == "drift" && trace.selected == std::vector<std::string>{"force_drift"};
}

namespace {

/// Whether a trace names what is inside, as 1 or 0.
double right(const BlindSet& set, const identification::Trace& t) {
  if (set.effect == "none") return t.selected.empty() && t.explained ? 1.0 : 0.0;
  if (set.effect == "drift" || set.effect == "damage") return is_right_outside(set, t) ? 1.0 : 0.0;
  if (t.selected.size() != 1) return 0.0;
  const std::vector<std::string>& members = t.selected_classes.front();
  return std::find(members.begin(), members.end(), set.effect) != members.end() ? 1.0 : 0.0;
}

std::vector<Row> blind_rows() {
  std::vector<Row> rows;
  for (const char* effect : {"none", "wire_length", "mount_slip", "contact_friction", "strand_hysteresis",
                             "force_offset", "drift"}) {
    const BlindSet set = make_blind_set(effect, 30.0, 101);
    identification::TraceOptions options;
    options.intervals = false;
    const identification::Trace t = identification::trace(set.experiment, options);
    const std::string source = "continuous wire by collocation, with the effect put in";
    rows.push_back({"tracing of blind sets", fmt::format("right answer, inside: {}", effect), "", source,
                    Kind::independent_code, 1.0, right(set, t), Limit::relative(0.5)});
    if (set.effect == "drift") continue;
    // 234 readings: chi2 over its degrees of freedom has a standard deviation of 0.09.
    rows.push_back({"tracing of blind sets",
                    fmt::format("chi2 a degree of freedom after, inside: {}", effect), "", source,
                    Kind::independent_code, 1.0, t.final.chi2_dof, Limit::relative(0.3)});
  }
  return rows;
}

identification::Experiment strand_experiment(const std::vector<std::filesystem::path>& files, double diameter,
                                             double span, double support_radius) {
  std::string text = fmt::format(R"(schema = "snare-experiment/1"
[wire]
construction = "strand"
diameter_mm = {}
length_mm = {}
youngs_modulus_GPa = 100.0
poisson_ratio = 0.3
density_kg_m3 = 8000.0
[mount]
kind = "supports"
span_mm = {}
support_radius_mm = {}
[pusher]
shape = "cylinder"
radius_mm = {}
friction = 0.0
direction = "inward"
)",
                                 diameter, span + 20.0, span, support_radius, support_radius);
  for (const std::filesystem::path& file : files) {
    text += fmt::format("[[series]]\nname = \"{}\"\ncontact_position_mm = {}\nfile = \"{}\"\n",
                        file.stem().string(), 0.5 * span, std::filesystem::absolute(file).string());
  }
  return identification::parse_experiment("measured.toml", text, identification::parameters());
}

/// What is left beside the replicates' scatter: of an effect that was named the error, a fifth above it at
/// most, as far as three replicates know it; where none was, the test against the replicates, which five
/// alone with 4.9 degrees of freedom of their smooth part let pass or not, whatever the ratio of the two.
Row scatter_row(const identification::Trace& t, const std::string& group, const std::string& source) {
  constexpr double most_over_scatter = 1.2;
  const double sigma = t.noise.sigma.empty() ? 1.0 : t.noise.sigma.front();
  if (t.selected.empty()) {
    return {"tracing of measured strands",
            fmt::format("{}: like the replicates' scatter (error over it {:.2f}, p = {:.2g})", group,
                        t.base.rmse / sigma, t.base_tests.lack_of_fit),
            "",
            source,
            Kind::published_measurement,
            1.0,
            t.base_tests.like_noise() ? 1.0 : 0.0,
            Limit::relative(0.5)};
  }
  return {"tracing of measured strands",
          fmt::format("{}: error after over the replicates' scatter (before {:.2f}), at most {}", group,
                      t.base.rmse / sigma, most_over_scatter),
          "",
          source,
          Kind::published_measurement,
          0.0,
          t.final.rmse / sigma,
          Limit::absolute(most_over_scatter,
                          "an upper bound; the value is a multiple of the scatter of the replicates")};
}

std::vector<Row> measured_rows(const std::vector<std::filesystem::path>& files, const std::string& group,
                               double diameter, double span, double support_radius) {
  const identification::Experiment e = strand_experiment(files, diameter, span, support_radius);
  const identification::Trace t = identification::trace(e);
  const std::string source = "measured: pulsevad-optimal, three-point bending of strands (replicates)";
  std::string answer =
      t.selected.empty() ? "nothing" : fmt::format("{}", fmt::join(t.selected_classes.front(), " or "));
  // An engineer's reading of the curves: group 4 softens as strands do that let go, group 5 is as straight as
  // its replicates are alike.
  const bool told = t.kind != identification::VerdictKind::not_explained;
  const bool one_of_the_strands =
      t.selected.empty() || t.selected == std::vector<std::string>{"strand_hysteresis"};
  return {{"tracing of measured strands", fmt::format("{}: {} ({})", group, to_string(t.kind), answer), "",
           source, Kind::published_measurement, 1.0, told ? 1.0 : 0.0, Limit::relative(0.5)},
          {"tracing of measured strands", fmt::format("{}: no culprit but the strands", group), "", source,
           Kind::published_measurement, 1.0, one_of_the_strands ? 1.0 : 0.0, Limit::relative(0.5)},
          scatter_row(t, group, source)};
}

}  // namespace

std::vector<Check> tracing_checks(const std::filesystem::path& measured) {
  std::vector<Check> checks{{"tracing of blind sets", blind_rows, ""}};
  struct Group {
    const char* name;
    double diameter, span, radius;  // [mm]
  };
  for (const Group& g : {Group{"group4", 2.5, 40.0, 2.0}, Group{"group5", 3.6, 57.6, 5.0}}) {
    std::vector<std::filesystem::path> files;
    for (int k = 1; k <= 9; ++k) {
      const std::filesystem::path file =
          measured / "three_point_bending" / fmt::format("{}_{}.csv", g.name, k);
      if (std::filesystem::exists(file)) files.push_back(file);
    }
    const std::string name = fmt::format("tracing of measured strands, {}", g.name);
    if (files.size() < 2) {
      checks.push_back({name, [] { return std::vector<Row>(); },
                        fmt::format("the measured files {}_*.csv are not in {}", g.name,
                                    (measured / "three_point_bending").string())});
      continue;
    }
    checks.push_back(
        {name, [files, g] { return measured_rows(files, g.name, g.diameter, g.span, g.radius); }, ""});
  }
  return checks;
}

}  // namespace snare::validation
