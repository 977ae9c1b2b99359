// How often the tracing names a culprit where there is none: readings of the continuous wire by collocation,
// stiffnesses off the declared ones by a tenth, with noise of several kinds that is not declared. One line a
// set and a summary as JSON.
//   null_benchmark [--seeds N] [--first SEED] [--readings 6,30,500,3000] [--kinds white,smooth,replicates]
//     [--out FILE]
//   [--sets FILE] [--minutes M]
// --sets keeps every set's outcome, one line of JSON each; a run of the same build that finds the file goes
// on where it ended. --minutes ends a run after a set. Rates of errors come with the upper end of their
// one-sided 95 % interval. Noise, as shares of the largest force: white 1 %; smooth 0.7 % (an
// Ornstein-Uhlenbeck process of a quarter of the travel) and white 0.5 %; replicates: six records to peak
// travels up to 5 % apart, each with a smooth deviation that goes with the force (3 % of it) and white 0.5 %.
// Readings are those of a record; six of them are one record, else two positions are pushed, of replicates
// one.

#include "base/files.hpp"
#include "base/units.hpp"
#include "identification/tracing/trace.hpp"
#include "numerics/cubic_spline.hpp"
#include "validation/blind_push.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <CLI/CLI.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <mutex>
#include <numbers>
#include <random>

using namespace snare;
using base::mm;

namespace {

struct Case {
  std::string kind;
  int readings = 0;
  unsigned seed = 0;
};

struct Outcome {
  bool culprit = false;
  std::string verdict, effects;
  double sigma_ratio = 0.0;  // estimated over true, of a reading
  double upper = 0.0;        // bound of what is left, over the largest force
  bool doubtful = false;     // the zero of the travel is said to be wrong
  double seconds = 0.0;
};

constexpr double diameter = 1.5 * mm;
constexpr double length = 176.0 * mm;
constexpr double span = 175.0 * mm;
constexpr double modulus = 193e9;
constexpr double radius = 6.0 * mm;
constexpr double travel = 2.4 * mm;

/// Force over travel of a wire whose stiffnesses are these shares of a half-solid one, at 120 points.
numerics::HermiteCurve curve(double position, double bending, double axial) {
  validation::BlindWire w;
  w.length = length;
  w.span = span;
  w.bending_stiffness = bending * 0.5 * modulus * std::numbers::pi * std::pow(diameter, 4) / 64.0;
  w.axial_stiffness = axial * 0.5 * modulus * std::numbers::pi * diameter * diameter / 4.0;
  w.diameter = diameter;
  w.position = position;
  w.radius = radius + 0.5 * diameter;
  w.intervals = 60;
  std::vector<double> d{0.0}, f{0.0}, asked;
  for (int i = 1; i <= 120; ++i) asked.push_back(travel * i / 120);
  for (const validation::BlindReading& r : validation::blind_push(w, asked)) f.push_back(r.force);
  d.insert(d.end(), asked.begin(), asked.end());
  return {std::move(d), std::move(f)};
}

/// A set, and the root mean square noise of its readings.
std::pair<identification::Experiment, double> make(const Case& c) {
  std::seed_seq seeds{c.seed, static_cast<unsigned>(c.readings), static_cast<unsigned>(c.kind.size())};
  std::mt19937 random(seeds);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const double bending = std::exp(0.1 * normal(random));
  const double axial = std::exp(0.1 * normal(random));
  const bool repeated = c.kind == "replicates";
  std::vector<double> positions{40.0 * mm};
  if (repeated) positions.assign(6, 65.0 * mm);
  if (!repeated && c.readings > 6) positions.push_back(90.0 * mm);
  identification::Experiment e;
  e.file = "null.toml";
  e.solver.elements = 64;
  double squares = 0.0;
  double count = 0.0;
  for (const double position : positions) {
    const auto f = curve(position, bending, axial);
    const double largest = f.value(travel);
    const double end = repeated ? travel * (1.0 - 0.05 * uniform(random)) : travel;
    identification::Series s;
    s.name = fmt::format("s{}", e.series.size());
    s.test.wire.construction = wire::Construction::strand;
    s.test.wire.diameter = diameter;
    s.test.wire.length = length;
    s.test.wire.youngs_modulus = 0.5 * modulus;
    s.test.wire.poisson_ratio = 0.29;
    s.test.wire.density = 7930.0;
    s.test.mount.span = span;
    s.test.pusher.radius = radius;
    s.test.contact_position = position;
    identification::Readings r;
    double state = normal(random);
    for (int i = 1; i <= c.readings; ++i) {
      const double d = end * i / c.readings;
      const double force = f.value(d);
      const double decay = i == 1 ? 1.0 : std::exp(-end / c.readings / (0.25 * travel));
      state = decay * state + std::sqrt(1.0 - decay * decay) * normal(random);
      double noise = 0.0;
      if (c.kind == "white") noise = 0.01 * largest * normal(random);
      if (c.kind == "smooth") noise = largest * (0.007 * state + 0.005 * normal(random));
      if (repeated) noise = 0.03 * force * state + 0.005 * largest * normal(random);
      const double part = c.kind == "white"    ? 0.01 * largest
                          : c.kind == "smooth" ? largest * std::hypot(0.007, 0.005)
                                               : std::hypot(0.03 * force, 0.005 * largest);
      squares += part * part;
      count += 1.0;
      r.displacement.push_back(d);
      r.force.push_back(force + noise);
    }
    s.test.travel = r.displacement;
    s.readings = std::move(r);
    e.series.push_back(std::move(s));
  }
  return {std::move(e), std::sqrt(squares / count)};
}

Outcome outcome_of(const Case& c) {
  const auto [experiment, sigma] = make(c);
  identification::TraceOptions options;
  options.intervals = false;
  const auto start = std::chrono::steady_clock::now();
  const identification::Trace t = identification::trace(experiment, options);
  Outcome o;
  o.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  o.culprit = !t.selected.empty();
  o.verdict = to_string(t.kind);
  o.effects = fmt::format("{}", fmt::join(t.selected, "+"));
  double square = 0.0;
  for (const double one : t.noise.sigma) square += one * one / static_cast<double>(t.noise.sigma.size());
  o.sigma_ratio = std::sqrt(square) / sigma;
  o.doubtful = t.zero && t.zero->doubtful;
  o.upper = t.peak_force > 0.0 ? t.remaining.upper / t.peak_force : 0.0;
  return o;
}

struct Totals {
  int sets = 0, culprits = 0, near = 0, doubtful = 0;
  double sigma = 0.0, seconds = 0.0, longest = 0.0;
  std::map<std::string, int> verdicts, named;
};

void add(Totals& t, const Outcome& o) {
  ++t.sets;
  t.culprits += o.culprit ? 1 : 0;
  t.near += std::abs(o.sigma_ratio - 1.0) < 0.2 ? 1 : 0;
  t.sigma += o.sigma_ratio;
  t.doubtful += o.doubtful ? 1 : 0;
  t.seconds += o.seconds;
  t.longest = std::max(t.longest, o.seconds);
  ++t.verdicts[o.verdict];
  if (o.culprit) ++t.named[o.effects];
}

nlohmann::json json_of(const Totals& t) {
  return {{"sets", t.sets},
          {"false_culprits", t.culprits},
          {"false_culprits_at_most",
           t.culprits < t.sets
               ? boost::math::binomial_distribution<>::find_upper_bound_on_p(t.sets, t.culprits, 0.05)
               : 1.0},
          {"zeros_in_doubt", t.doubtful},
          {"named", t.named},
          {"verdicts", t.verdicts},
          {"mean_sigma_over_truth", t.sigma / std::max(1, t.sets)},
          {"share_with_sigma_within_20_percent", static_cast<double>(t.near) / std::max(1, t.sets)},
          {"mean_seconds", t.seconds / std::max(1, t.sets)},
          {"longest_seconds", t.longest}};
}

nlohmann::json line_of(const Case& c, const Outcome& o) {
  return {{"kind", c.kind},       {"readings", c.readings}, {"seed", c.seed},         {"culprit", o.culprit},
          {"verdict", o.verdict}, {"effects", o.effects},   {"sigma", o.sigma_ratio}, {"left", o.upper},
          {"zero", o.doubtful},   {"seconds", o.seconds}};
}

/// Outcomes of an earlier run, as far as they are whole lines.
std::map<std::size_t, Outcome> read_sets(const std::string& file, const std::vector<Case>& cases) {
  std::map<std::size_t, Outcome> outcomes;
  std::ifstream in(file);
  for (std::string text; std::getline(in, text);) {
    const nlohmann::json line = nlohmann::json::parse(text, nullptr, false);
    if (line.is_discarded()) continue;
    const auto at = std::ranges::find_if(cases, [&line](const Case& c) {
      return c.kind == line["kind"] && c.readings == line["readings"] && c.seed == line["seed"];
    });
    if (at == cases.end()) continue;
    outcomes[static_cast<std::size_t>(at - cases.begin())] = {
        line["culprit"], line["verdict"], line["effects"], line["sigma"],
        line["left"],    line["zero"],    line["seconds"]};
  }
  return outcomes;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"false culprits of the tracing on readings without any effect"};
  unsigned seeds = 34;
  unsigned first = 1;
  std::vector<int> readings{6, 30, 500, 3000};
  std::vector<std::string> kinds{"white", "smooth", "replicates"};
  std::string out;
  app.add_option("--seeds", seeds);
  app.add_option("--first", first);
  app.add_option("--readings", readings)->delimiter(',');
  app.add_option("--kinds", kinds)->delimiter(',');
  app.add_option("--out", out);
  std::string sets;
  double minutes = 1e9;
  app.add_option("--sets", sets);
  app.add_option("--minutes", minutes);
  CLI11_PARSE(app, argc, argv);

  std::vector<Case> cases;
  for (unsigned s = first; s < first + seeds; ++s) {
    for (const std::string& kind : kinds) {
      for (const int n : readings) cases.push_back({kind, n, s});
    }
  }
  Totals all;
  std::map<std::string, Totals> parts;
  const std::map<std::size_t, Outcome> known = read_sets(sets, cases);
  for (const auto& [i, o] : known) {
    add(all, o);
    add(parts[fmt::format("{} {}", cases[i].kind, cases[i].readings)], o);
  }
  std::ofstream journal;
  if (!sets.empty()) journal.open(sets, std::ios::app);
  const auto began = std::chrono::steady_clock::now();
  std::mutex mutex;
  omp_set_max_active_levels(1);
  const auto write = [&] {
    nlohmann::json result{{"schema", "snare-null/1"}, {"all", json_of(all)}};
    for (const auto& [name, totals] : parts) result["parts"][name] = json_of(totals);
    if (!out.empty()) base::write_text(out, result.dump(1) + "\n");
    return result;
  };
#pragma omp parallel for schedule(dynamic, 1)
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(cases.size()); ++i) {
    const Case& c = cases[static_cast<std::size_t>(i)];
    if (known.contains(static_cast<std::size_t>(i))) continue;
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count() > 60.0 * minutes)
      continue;
    Outcome o;
    try {
      o = outcome_of(c);
    } catch (const std::exception& error) {
      o.verdict = std::string("error: ") + error.what();
    }
    const std::lock_guard lock(mutex);
    add(all, o);
    add(parts[fmt::format("{} {}", c.kind, c.readings)], o);
    fmt::print("{} {} {} seed {}: {} {} sigma {:.2f} left {:.4f} ({:.2f} s)\n", o.culprit ? "WRONG" : "ok   ",
               c.kind, c.readings, c.seed, o.verdict, o.effects, o.sigma_ratio, o.upper, o.seconds);
    std::fflush(stdout);
    journal << line_of(c, o).dump() << std::endl;
    write();
  }
  fmt::print("{}\n", write().dump(1));
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
