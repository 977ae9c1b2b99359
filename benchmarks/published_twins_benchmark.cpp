// How often published fits are explained by what made them: fits of computed tests whose range, number of
// readings, zeros and scatter are drawn, as those that a paper prints. One line a set and a summary as JSON.
//   published_twins_benchmark [--experiment FILE] [--truths N] [--draws M] [--sets FILE] [--minutes M]
//     [--out FILE]
// The declared test with mounts that give, a rope, or a mount in which the wire slips: N truths (20) each,
// with M draws (5) of range, readings, zeros and noise each. Coarse maps. --sets keeps every set's outcome,
// one line of JSON each; a run that finds the file resumes there. --minutes ends a run after a set.

#include "base/files.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/prediction.hpp"
#include "identification/published/curve_likelihood.hpp"
#include "identification/published/published_map.hpp"
#include "numerics/cubic_spline.hpp"
#include "results/published_map.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <numbers>
#include <random>

using namespace snare;
using namespace snare::identification;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::json;

namespace {

struct Truth {
  std::string kind;
  std::vector<std::pair<std::string, double>> values;  // SI; of ratios over the declared value
};

double even_in_log(std::mt19937_64& random, double low, double high) {
  return low * std::pow(high / low, std::uniform_real_distribution(0.0, 1.0)(random));
}

Truth draw_truth(const std::string& kind, unsigned number) {
  std::seed_seq seeds{number, static_cast<unsigned>(kind.size()), 1U};
  std::mt19937_64 random(seeds);
  if (kind == "mount_axial_compliance")
    return {kind, {{"mount_axial_compliance.compliance_m_N", even_in_log(random, 3e-6, 5e-5)}}};
  if (kind == "rope") {
    const double bending = even_in_log(random, 0.05, 1.0);
    return {kind,
            {{"wire.bending_stiffness_Nm2", bending},
             {"wire.axial_stiffness_N", even_in_log(random, 0.02, 0.5)}}};
  }
  return {kind, {{"mount_slip.tension_N", even_in_log(random, 3.0, 100.0)}}};
}

/// Force over travel from first touch of every series, as far as it could be followed [m].
struct Made {
  std::vector<numerics::HermiteCurve> force;
  std::vector<double> reach;
};

Made make(const Experiment& experiment, const FitRanges& ranges, const Truth& truth) {
  std::vector<Series> series = experiment.series;
  constexpr int points = 400;
  const double reach = ranges.longest() + largest_zero;
  for (Series& s : series) {
    s.law->to = reach;
    s.test.travel.clear();
    for (int i = 0; i <= points; ++i) s.test.travel.push_back(reach * i / points);
  }
  SolverSettings solver = experiment.solver;
  solver.elements = 96;
  std::vector<Setting> settings;
  for (const auto& [key, value] : truth.values) {
    const Parameter& p = parameters().at(key);
    settings.push_back({&p, p.parametrisation == Parametrisation::shift ? value : std::log(value)});
  }
  const Model model(series, solver);
  Made made;
  const Evaluation e = model.evaluate(settings);
  for (std::size_t k = 0; k < series.size(); ++k) {
    const std::vector<double>& force = e.predictions[k].force;
    const std::vector<double>& travel = measured_displacement(model.series()[k]);
    std::vector<double> knots(travel.begin(), travel.begin() + static_cast<std::ptrdiff_t>(force.size()));
    if (knots.size() < 2) return {};
    made.reach.push_back(knots.back());
    made.force.emplace_back(std::move(knots), force);
  }
  return made;
}

/// Ranges of the series as the prior has them [m].
std::vector<double> draw_ranges(const FitRanges& ranges, std::mt19937_64& random) {
  const double u = std::uniform_real_distribution(0.0, 1.0)(random);
  const double least = 2e-3, most = 18e-3;
  if (u < 0.5) {
    const std::size_t taut = ranges.taut().size();
    return ranges.taut()[u < 0.25 ? 0 : taut - 1].to;
  }
  std::vector<double> to(ranges.series(), even_in_log(random, least, most));
  if (u > 0.75)
    for (double& one : to) one = even_in_log(random, least, most);
  return to;
}

/// Laws as a paper prints them, with their ranges, readings and scatter.
struct Printed {
  std::vector<QuadraticLaw> laws;
  std::vector<double> to;
  int readings = 0;
  double sigma = 0.0;
};

std::optional<Printed> print(const Made& made, const FitRanges& ranges, std::mt19937_64& random) {
  std::uniform_real_distribution<double> zero(-2e-3, 2e-3);
  Printed printed;
  printed.to = draw_ranges(ranges, random);
  printed.readings = static_cast<int>(std::lround(even_in_log(random, 6.0, 200.0)));
  double largest = 0.0;
  std::vector<double> zeros;
  for (std::size_t k = 0; k < made.force.size(); ++k) {
    zeros.push_back(std::clamp(zero(random), -0.3 * printed.to[k], 0.3 * printed.to[k]));
    if (printed.to[k] - zeros[k] > made.reach[k]) return std::nullopt;
    largest = std::max(largest, made.force[k].value(printed.to[k] - zeros[k]));
  }
  printed.sigma = largest * even_in_log(random, 0.003, 0.03);
  std::normal_distribution<double> noise(0.0, printed.sigma);
  for (std::size_t k = 0; k < made.force.size(); ++k) {
    std::vector<double> travel;
    VectorXd force(printed.readings);
    for (int i = 0; i < printed.readings; ++i) {
      travel.push_back(printed.to[k] * i / (printed.readings - 1));
      force[i] = made.force[k].value(std::max(0.0, travel.back() - zeros[k])) + noise(random);
    }
    printed.laws.push_back(printed_law(travel, force, 4));
    if (!(printed.laws.back().r_squared > 0.0)) return std::nullopt;
  }
  return printed;
}

/// Whether 95 % of the posterior of a number, given its hypothesis, hold its true value, under the first
/// prior.
bool covers(const HypothesisMap& map, std::size_t number, double truth) {
  double below = 0.0, all = 0.0;
  for (const PosteriorPoint& p : map.posterior) {
    const double weight = std::exp(p.log_weight[0] - map.log_evidence[0]);
    all += weight;
    if (p.values[number] < truth) below += weight;
  }
  return below > 0.025 * all && below < 0.975 * all;
}

json outcome(Experiment experiment, const FitRanges& ranges, const Truth& truth, const Printed& printed) {
  for (std::size_t k = 0; k < printed.laws.size(); ++k) experiment.series[k].law = printed.laws[k];
  const MapOptions options = coarse_map();
  const std::vector<Hypothesis> hypotheses = published_hypotheses();
  const std::vector<HypothesisMap> maps =
      published_map(experiment, ranges.of(printed.laws), hypotheses, options);
  const auto right =
      std::ranges::find_if(maps, [&](const HypothesisMap& m) { return m.hypothesis.name == truth.kind; });
  std::map<std::string, std::array<double, 2>> families;
  double log_rival = -1e300, log_right = -1e300;
  for (const HypothesisMap& m : maps) {
    const bool own = m.hypothesis.family == right->hypothesis.family;
    for (std::size_t prior = 0; prior < 2; ++prior)
      families[m.hypothesis.family][prior] += m.probability[prior];
    double& log = own ? log_right : log_rival;
    log = std::max(log, m.log_evidence[0]);
  }
  std::string leading;
  double most = -1.0, wrong = 0.0;
  for (const auto& [name, p] : families) {
    const double least = std::min(p[0], p[1]);
    if (least > most) most = least, leading = name;
    if (name != right->hypothesis.family) wrong = std::max(wrong, least);
  }
  // Ends of intervals need more computed tests than the evidence does.
  MapOptions finer = options;
  finer.effective = 150.0, finer.most_batches = 60;
  const HypothesisMap posterior =
      published_map(experiment, ranges.of(printed.laws), {right->hypothesis}, finer).front();
  json covered = json::array();
  for (std::size_t j = 0; j < truth.values.size(); ++j) {
    const auto& numbers = right->hypothesis.numbers;
    const auto at =
        std::ranges::find_if(numbers, [&](const PriorNumber& n) { return n.key == truth.values[j].first; });
    covered.push_back(
        covers(posterior, static_cast<std::size_t>(at - numbers.begin()), truth.values[j].second));
  }
  return {{"log_bayes_factor", std::clamp(log_right - log_rival, -1e3, 1e3)},
          {"right", leading == right->hypothesis.family},
          {"probability", most},
          {"wrong", wrong},
          {"effective", posterior.effective},
          {"covered", covered}};
}

/// Shares over all sets that tell.
json summary(const std::vector<json>& sets, int draws) {
  json all = json::object();
  int covered = 0, numbers = 0;
  std::map<std::string, std::vector<const json*>> kinds;
  for (const json& s : sets) {
    kinds[s["kind"].get<std::string>()].push_back(&s);
    for (const json& c : s["covered"]) covered += c.get<bool>() ? 1 : 0, ++numbers;
  }
  for (const auto& [kind, of] : kinds) {
    std::map<int, double> sum;
    std::map<int, int> count;
    for (const json* s : of)
      sum[(*s)["truth"]] += (*s)["log_bayes_factor"].get<double>(), ++count[(*s)["truth"]];
    int tell = 0, right = 0, wrong = 0;
    for (const json* s : of) {
      const int truth = (*s)["truth"];
      // of the other draws of the same truth
      const double expected =
          count[truth] > 1 ? (sum[truth] - (*s)["log_bayes_factor"].get<double>()) / (count[truth] - 1) : 0.0;
      if (expected >= 3.0) ++tell, right += (*s)["right"].get<bool>() ? 1 : 0;
      wrong += (*s)["wrong"].get<double>() >= 0.95 ? 1 : 0;
    }
    all[kind] = {
        {"sets", of.size()}, {"can_tell", tell}, {"right_where_it_can", right}, {"wrong_at_95", wrong}};
  }
  return {{"kinds", all}, {"draws_a_truth", draws}, {"intervals", numbers}, {"intervals_that_hold", covered}};
}

}  // namespace

int main(int argc, char** argv) try {
  std::string file = SNARE_BENCHMARK_DATA "/experiments/published_static.toml", out, kept;
  int truths = 20, draws = 5;
  double minutes = 1e9;
  CLI::App app{"Published fits of known tests"};
  app.add_option("--experiment", file);
  app.add_option("--truths", truths);
  app.add_option("--draws", draws);
  app.add_option("--sets", kept);
  app.add_option("--minutes", minutes);
  app.add_option("--out", out);
  CLI11_PARSE(app, argc, argv);
  const auto begin = std::chrono::steady_clock::now();
  const Experiment experiment = read_experiment(file, parameters());
  const FitRanges ranges = fit_ranges(experiment, coarse_map());
  std::vector<json> sets;
  if (!kept.empty())
    for (std::ifstream in(kept); in && in.peek() != EOF;) {
      std::string line;
      std::getline(in, line);
      if (!line.empty()) sets.push_back(json::parse(line));
    }
  for (int t = 0; t < truths; ++t) {
    for (const std::string kind : {"mount_axial_compliance", "rope", "mount_slip"}) {
      const Truth truth = draw_truth(kind, static_cast<unsigned>(t));
      std::optional<Made> made;
      std::seed_seq seeds{static_cast<unsigned>(t), static_cast<unsigned>(kind.size()), 2U};
      std::mt19937_64 random(seeds);
      for (int d = 0; d < draws; ++d) {
        const bool done = std::ranges::any_of(
            sets, [&](const json& s) { return s["kind"] == kind && s["truth"] == t && s["draw"] == d; });
        if (!made) made = make(experiment, ranges, truth);
        std::optional<Printed> printed;
        while (!printed) printed = print(*made, ranges, random);
        if (done) continue;
        json line{{"kind", kind},
                  {"truth", t},
                  {"draw", d},
                  {"readings", printed->readings},
                  {"sigma_N", printed->sigma}};
        for (const auto& [key, value] : truth.values) line["values"][key] = value;
        for (const double to : printed->to) line["to_mm"].push_back(1e3 * to);
        line.update(outcome(experiment, ranges, truth, *printed));
        fmt::print("{}\n", line.dump());
        std::fflush(stdout);
        if (!kept.empty()) std::ofstream(kept, std::ios::app) << line.dump() << '\n';
        sets.push_back(std::move(line));
        const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        if (spent > 60.0 * minutes) return 0;
      }
    }
  }
  const json result = summary(sets, draws);
  fmt::print("{}\n", result.dump(1));
  if (!out.empty()) base::write_text(out, result.dump(1) + "\n");
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
