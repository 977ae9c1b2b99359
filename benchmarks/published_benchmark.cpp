// Whether the P of published fits is what it says: readings of a wire with noise are made up and fitted as a
// paper does, only the printed numbers are kept, and the wire that made them is judged by its likelihood. Its
// P must be uniform.
//   published_benchmark [--sets N] [--readings 6,8,12,20,40] [--sigma N] [--digits D] [--seed S]
//     [--experiment FILE] [--out FILE]
// The wire is that of the published static tests with its six numbers at values near those that are fitted to
// them, the fits reach to 4 mm. One line a number of readings, and JSON: `uniform_p` of a Kolmogorov-Smirnov
// test, the shares of P below 5 and 1 %, and the mean of the estimated variance over the true one before its
// bias is corrected.

#include "base/files.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/published_fit.hpp"
#include "identification/fitting/statistics.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <random>

using namespace snare;
using namespace snare::identification;

namespace {

struct Choice {
  int sets = 500;
  std::vector<int> readings{6, 8, 12, 20, 40};
  double sigma = 0.15;
  int digits = 4;
  unsigned seed = 1;
  std::string experiment = "data/experiments/published_static.toml";
  std::string out;
};

/// The wire's numbers, near those of the fit to the published numbers.
std::vector<Setting> truth_of(const Experiment& experiment) {
  const std::vector<double> values{0.0085, 18e3, 175.6, 0.3, 1.1, 1.6};
  const Model declared(experiment.series, experiment.solver);
  std::vector<Setting> settings;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Parameter& p = parameters().at(experiment.free.at(k));
    settings.push_back({&p, p.coordinate(declared.declared(p), values[k] * p.unit_size)});
  }
  return settings;
}

double share_below(const std::vector<double>& values, double level) {
  const auto below = std::ranges::count_if(values, [&](double v) { return v < level; });
  return static_cast<double>(below) / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

nlohmann::json judged(Experiment experiment, int readings, const Choice& choice) {
  for (Series& s : experiment.series) {
    s.test.travel.clear();
    for (int i = 0; i < readings; ++i) s.test.travel.push_back(s.law->to * i / (readings - 1));
  }
  const std::vector<Setting> truth = truth_of(experiment);
  const Evaluation curves = Model(experiment.series, experiment.solver).evaluate(truth);
  if (!curves.complete) throw std::runtime_error(curves.message);
  std::mt19937_64 random(choice.seed + 1000U * static_cast<unsigned>(readings));
  std::normal_distribution<double> normal;
  const std::vector<std::size_t> all{0, 1, 2};
  std::vector<double> p;
  double variance = 0.0;
  const auto began = std::chrono::steady_clock::now();
  for (int k = 0; k < choice.sets; ++k) {
    std::vector<Series> series = experiment.series;
    for (std::size_t j = 0; j < series.size(); ++j) {
      Eigen::VectorXd y = curves.force[j];
      for (double& one : y) one += choice.sigma * normal(random);
      series[j].law = printed_law(series[j].test.travel, y, choice.digits);
    }
    const SummaryStatistics found =
        summary_statistics(Model(series, experiment.solver), all, truth, truth.size());
    p.push_back(found.p);
    variance += found.scatter * found.scatter / (choice.sigma * choice.sigma) / choice.sets;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  const nlohmann::json result{{"readings", readings},
                              {"sets", choice.sets},
                              {"uniform_p", uniform_p(p)},
                              {"below_5_percent", share_below(p, 0.05)},
                              {"below_1_percent", share_below(p, 0.01 + 1e-9)},
                              {"corrected_variance_over_true", variance},
                              {"seconds_a_set", seconds / choice.sets}};
  fmt::print("{}\n", result.dump());
  std::fflush(stdout);
  return result;
}

}  // namespace

int main(int argc, char** argv) try {
  Choice choice;
  CLI::App app{"P of published fits of sets that their own wire made"};
  app.add_option("--sets", choice.sets);
  app.add_option("--readings", choice.readings)->delimiter(',');
  app.add_option("--sigma", choice.sigma);
  app.add_option("--digits", choice.digits);
  app.add_option("--seed", choice.seed);
  app.add_option("--experiment", choice.experiment);
  app.add_option("--out", choice.out);
  CLI11_PARSE(app, argc, argv);
  Experiment experiment = read_experiment(choice.experiment, parameters());
  experiment.solver.elements = 32;  // the same wire makes the readings and is fitted to them
  experiment.solver.extrapolate = false;
  nlohmann::json result{
      {"schema", "snare-published/1"}, {"sigma_N", choice.sigma}, {"R2_digits", choice.digits}};
  for (const int readings : choice.readings) result["parts"].push_back(judged(experiment, readings, choice));
  if (!choice.out.empty()) base::write_text(choice.out, result.dump(1) + "\n");
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
