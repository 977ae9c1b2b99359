// How often published fits are explained by what made them: fits of computed tests whose range, number of
// readings, zeros and scatter are drawn, as those that a paper prints. One line a set and a summary as JSON.
//   published_twins_benchmark [--experiment FILE] [--truths N] [--draws M] [--sets FILE] [--minutes M]
//     [--out FILE]
// The declared test with mounts that give, a rope, or a mount in which the wire slips: N truths (20) each,
// with M draws (5) of range, readings, zeros and noise each. Coarse maps. --sets keeps every set's outcome,
// one line of JSON each; a run that finds the file resumes there. --minutes ends a run after a set.

#include "base/files.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/published/published_map.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <random>

using namespace snare;
using namespace snare::identification;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::json;

namespace {

/// A hypothesis with numbers, in its order and in SI, of ratios over the declared value.
struct Truth {
  Hypothesis hypothesis;
  std::vector<double> values;
};

double even_in_log(std::mt19937_64& random, double low, double high) {
  return low * std::pow(high / low, std::uniform_real_distribution(0.0, 1.0)(random));
}

Truth draw_truth(const std::string& kind, unsigned number) {
  std::seed_seq seeds{number, static_cast<unsigned>(kind.size()), 1U};
  std::mt19937_64 random(seeds);
  const std::vector<Hypothesis> all = published_hypotheses();
  Truth truth{*std::ranges::find(all, kind, &Hypothesis::name), {}};
  if (kind == "mount_axial_compliance") {
    truth.values = {even_in_log(random, 3e-6, 5e-5)};
  } else if (kind == "rope") {  // bending and axial stiffness
    truth.values = {even_in_log(random, 0.05, 1.0)};
    truth.values.push_back(even_in_log(random, 0.02, 0.5));
  } else {
    truth.values = {even_in_log(random, 3.0, 100.0)};
  }
  return truth;
}

/// Ranges of the series as the prior has them [m].
std::vector<double> draw_ranges(const FitRanges& ranges, std::mt19937_64& random) {
  const double u = std::uniform_real_distribution(0.0, 1.0)(random);
  const double least = FitRanges::Options{}.least, most = FitRanges::Options{}.most;
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

std::optional<Printed> print(const std::vector<TouchCurve>& made, const FitRanges& ranges,
                             std::mt19937_64& random) {
  std::uniform_real_distribution<double> zero(-2e-3, 2e-3);
  Printed printed;
  printed.to = draw_ranges(ranges, random);
  printed.readings = static_cast<int>(std::lround(even_in_log(random, 6.0, 200.0)));
  double largest = 0.0;
  std::vector<double> zeros;
  for (std::size_t k = 0; k < made.size(); ++k) {
    zeros.push_back(std::clamp(zero(random), -0.3 * printed.to[k], 0.3 * printed.to[k]));
    if (printed.to[k] - zeros[k] > made[k].reach) return std::nullopt;
    largest = std::max(largest, made[k].force.value(printed.to[k] - zeros[k]));
  }
  printed.sigma = largest * even_in_log(random, 0.003, 0.03);
  std::normal_distribution<double> noise(0.0, printed.sigma);
  for (std::size_t k = 0; k < made.size(); ++k) {
    std::vector<double> travel;
    VectorXd force(printed.readings);
    for (int i = 0; i < printed.readings; ++i) {
      travel.push_back(printed.to[k] * i / (printed.readings - 1));
      force[i] = made[k].force.value(std::max(0.0, travel.back() - zeros[k])) + noise(random);
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
  const std::string& family = truth.hypothesis.family;
  std::map<std::string, std::array<double, 2>> families;
  double log_rival = -1e300, log_right = -1e300;
  for (const HypothesisMap& m : maps) {
    const bool own = m.hypothesis.family == family;
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
    if (name != family) wrong = std::max(wrong, least);
  }
  // Ends of intervals need more computed tests than the evidence does.
  MapOptions finer = options;
  finer.effective = 150.0, finer.most_batches = 60;
  const HypothesisMap posterior =
      published_map(experiment, ranges.of(printed.laws), {truth.hypothesis}, finer).front();
  json covered = json::array();
  for (std::size_t j = 0; j < truth.values.size(); ++j)
    covered.push_back(covers(posterior, j, truth.values[j]));
  return {{"log_bayes_factor", std::clamp(log_right - log_rival, -1e3, 1e3)},
          {"right", leading == family},
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
  constexpr int elements = 96;  // finer than those of the maps
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
      std::vector<TouchCurve> made;
      std::seed_seq seeds{static_cast<unsigned>(t), static_cast<unsigned>(kind.size()), 2U};
      std::mt19937_64 random(seeds);
      for (int d = 0; d < draws; ++d) {
        const bool done = std::ranges::any_of(
            sets, [&](const json& s) { return s["kind"] == kind && s["truth"] == t && s["draw"] == d; });
        if (made.empty())
          made = computed_curves(experiment, ranges, truth.hypothesis, truth.values, elements);
        std::optional<Printed> printed;
        while (!printed) printed = print(made, ranges, random);
        if (done) continue;
        json line{{"kind", kind},
                  {"truth", t},
                  {"draw", d},
                  {"readings", printed->readings},
                  {"sigma_N", printed->sigma}};
        for (std::size_t j = 0; j < truth.values.size(); ++j)
          line["values"][truth.hypothesis.numbers[j].key] = truth.values[j];
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
