#include "identification/published/published_map.hpp"

#include "base/parallel.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/prediction.hpp"
#include "identification/published/curve_likelihood.hpp"
#include "identification/published/importance_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace snare::identification {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double none = -std::numeric_limits<double>::infinity();

/// Series whose published fits are replaced by travels from first touch, as far as any fit may reach.
std::vector<Series> long_pushes(std::vector<Series> series, double reach) {
  constexpr int points = 240;
  for (Series& s : series) {
    s.law->to = reach;
    s.test.travel.clear();
    for (int i = 0; i <= points; ++i) s.test.travel.push_back(reach * i / points);
  }
  return series;
}

/// The computed force of each series as far as it could be followed.
std::vector<TouchCurve> touch_curves(const std::vector<Prediction>& predictions, const std::vector<Series>& series) {
  std::vector<TouchCurve> curves;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const std::vector<double>& force = predictions[k].force;
    const std::vector<double>& travel = measured_displacement(series[k]);
    std::vector<double> knots(travel.begin(), travel.begin() + static_cast<std::ptrdiff_t>(force.size()));
    if (knots.size() < 2) return {};
    const double reach = knots.back();
    curves.push_back({numerics::HermiteCurve(std::move(knots), force), reach});
  }
  return curves;
}

double value_at(const PriorNumber& n, double u) {
  return n.logarithmic ? n.lower * std::pow(n.upper / n.lower, u) : n.lower + (n.upper - n.lower) * u;
}

/// log p of the published fits at one range and number of readings by every scatter, common to all series.
struct ByScatter {
  Eigen::ArrayXd log_sigma, log;
};
ByScatter by_scatter(const FitRanges& ranges, const std::vector<TouchCurve>& curves, std::size_t r, std::size_t n) {
  double centre = 0.0;
  for (std::size_t k = 0; k < curves.size(); ++k)
    centre += ranges.cell(r, n, k).log_scatter / static_cast<double>(curves.size());
  ByScatter all{centre + first_scatter + scatter_step * Eigen::ArrayXd::LinSpaced(scatters, 0.0, scatters - 1.0),
                Eigen::ArrayXd::Zero(scatters)};
  for (std::size_t k = 0; k < curves.size(); ++k) {
    all.log += log_likelihoods(ranges.cell(r, n, k), curves[k], all.log_sigma);
    if (!(all.log.maxCoeff() > none)) break;
  }
  return all;
}

/// log p of the published fits at every range and number of readings, range by range; the scatter even in its logarithm (Jeffreys).
std::vector<double> of_all_ranges(const FitRanges& ranges, const std::vector<TouchCurve>& curves) {
  std::vector<double> result;
  for (std::size_t r = 0; r < ranges.ranges().size(); ++r) {
    for (std::size_t n = 0; n < ranges.readings().size(); ++n) {
      if (curves.size() != ranges.series()) {
        result.push_back(none);
        continue;
      }
      const ByScatter all = by_scatter(ranges, curves, r, n);
      result.push_back(log_sum(std::vector<double>(all.log.begin(), all.log.end())) + std::log(scatter_step));
    }
  }
  return result;
}

/// The largest log p over ranges and numbers of readings if every published parabola were exact, with a scatter of its own.
double of_parabolas(const FitRanges& ranges) {
  double best = none;
  for (std::size_t r = 0; r < ranges.ranges().size(); ++r) {
    for (std::size_t n = 0; n < ranges.readings().size(); ++n) {
      double sum = 0.0;
      for (std::size_t k = 0; k < ranges.series(); ++k) {
        const FitCell& cell = ranges.cell(r, n, k);
        const auto components = static_cast<double>(cell.basis.cols() - 3);
        sum += length_probability(cell.numbers.lower, cell.numbers.upper, components, 0.0, cell.log_scatter).log -
               3.0 * cell.log_scatter + cell.log_scale;
      }
      best = std::max(best, sum);
    }
  }
  return best;
}

/// T of published_p.
double fit_statistic(const FitRanges& ranges, const std::vector<std::vector<TouchCurve>>& likely) {
  double best = none;
  for (const std::vector<TouchCurve>& curves : likely)
    best = std::max(best, std::ranges::max(of_all_ranges(ranges, curves)));
  return best - of_parabolas(ranges);
}

/// One hypothesis: its test as a function of its numbers.
class Computed {
 public:
  Computed(const Experiment& experiment, const FitRanges& ranges, const Hypothesis& hypothesis, int elements)
      : hypothesis_(hypothesis), model_(pushes(experiment, ranges, hypothesis), solver(experiment, elements)) {}

  [[nodiscard]] std::vector<double> values(const VectorXd& u) const {
    std::vector<double> result;
    for (std::size_t j = 0; j < hypothesis_.numbers.size(); ++j)
      result.push_back(value_at(hypothesis_.numbers[j], u[static_cast<Index>(j)]));
    return result;
  }

  [[nodiscard]] std::vector<TouchCurve> curves(const std::vector<double>& values) const {
    std::vector<Setting> settings;
    for (std::size_t j = 0; j < values.size(); ++j) {
      const Parameter& p = parameters().at(hypothesis_.numbers[j].key);
      settings.push_back({&p, p.parametrisation == Parametrisation::shift ? values[j] : std::log(values[j])});
    }
    const Evaluation e = model_.evaluate(settings);
    return touch_curves(e.predictions, model_.series());
  }

 private:
  static std::vector<Series> pushes(const Experiment& experiment, const FitRanges& ranges,
                                    const Hypothesis& hypothesis) {
    std::vector<Series> series = long_pushes(experiment.series, ranges.longest() + largest_zero);
    if (hypothesis.change != nullptr)
      for (Series& s : series) hypothesis.change(s.test);
    return series;
  }
  static SolverSettings solver(const Experiment& experiment, int elements) {
    SolverSettings settings = experiment.solver;
    settings.elements = std::min(settings.elements, elements);
    return settings;
  }

  const Hypothesis& hypothesis_;
  Model model_;
};

HypothesisMap map_of(const Experiment& experiment, const FitRanges& ranges, const Hypothesis& hypothesis,
                     const MapOptions& options) {
  const Computed computed(experiment, ranges, hypothesis, options.elements);
  const std::size_t columns = ranges.readings().size(), cells = ranges.ranges().size() * columns;
  std::vector<std::vector<double>> logs, values;  // one a computed test
  std::vector<double> mass;
  for (std::size_t c = 0; c < cells; ++c) mass.push_back(std::log(ranges.mass(c / columns, false)));
  const auto integrand = [&](const std::vector<VectorXd>& points) {
    const std::size_t before = logs.size();
    logs.resize(before + points.size());
    values.resize(logs.size());
    base::parallel_for(points.size(), [&](std::size_t i) {
      values[before + i] = computed.values(points[i]);
      logs[before + i] = of_all_ranges(ranges, computed.curves(values[before + i]));
    });
    std::vector<double> result;
    for (std::size_t i = before; i < logs.size(); ++i) {
      std::vector<double> terms(cells);
      for (std::size_t c = 0; c < cells; ++c) terms[c] = mass[c] + logs[i][c];
      result.push_back(log_sum(terms));
    }
    return result;
  };
  const auto n = static_cast<Index>(hypothesis.numbers.size());
  const int count = std::max(1, static_cast<int>(n));
  const WeightedPoints points =
      n == 0 ? WeightedPoints{{VectorXd(0)}, {0.0}}
             : sample_by_importance(n, options.first * count, options.batch * count, options.batches, integrand);
  if (n == 0) static_cast<void>(integrand(points.points));

  HypothesisMap map{.hypothesis = hypothesis, .cells = {}, .likely = {}};
  std::vector<double> evidence[2];
  for (std::size_t c = 0; c < cells; ++c) {
    std::vector<double> terms;
    std::size_t best = 0;
    for (std::size_t s = 0; s < logs.size(); ++s) {
      terms.push_back(points.log_weight[s] + logs[s][c]);
      if (logs[s][c] > logs[best][c]) best = s;
    }
    MapCell cell{c / columns, c % columns, log_sum(terms), logs[best][c], values[best]};
    for (int prior = 0; prior < 2; ++prior)
      evidence[prior].push_back(cell.log_evidence + std::log(ranges.mass(cell.range, prior == 1)));
    map.cells.push_back(std::move(cell));
  }
  for (int prior = 0; prior < 2; ++prior) map.log_evidence[prior] = log_sum(evidence[prior]);
  const MapCell& leading = leading_cell(map, ranges);
  const std::size_t at = leading.range * columns + leading.readings;
  std::vector<std::size_t> order(logs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t s) { return logs[s][at]; });
  constexpr std::size_t most_likely = 6;
  for (std::size_t i = 0; i < std::min(most_likely, order.size()); ++i) map.likely.push_back(values[order[i]]);
  return map;
}

}  // namespace

const MapCell& leading_cell(const HypothesisMap& map, const FitRanges& ranges) {
  return *std::ranges::max_element(
      map.cells, {}, [&](const MapCell& c) { return c.log_evidence + std::log(ranges.mass(c.range, false)); });
}

double published_p(const Experiment& experiment, const FitRanges& ranges, const HypothesisMap& map,
                   const MapOptions& options, int replicates) {
  const Computed computed(experiment, ranges, map.hypothesis, options.elements);
  std::vector<std::vector<TouchCurve>> likely;
  for (const std::vector<double>& values : map.likely) likely.push_back(computed.curves(values));
  const MapCell& leading = leading_cell(map, ranges);
  const std::vector<TouchCurve>& truth = likely.front();
  const ByScatter scatter = by_scatter(ranges, truth, leading.range, leading.readings);
  Eigen::Index best = 0;
  scatter.log.maxCoeff(&best);
  const double sigma = std::exp(scatter.log_sigma[best]);
  const double observed = fit_statistic(ranges, likely);
  std::vector<int> as_far(static_cast<std::size_t>(replicates));
  base::parallel_for(as_far.size(), [&](std::size_t i) {
    std::mt19937_64 random(i + 1);
    std::normal_distribution<double> noise(0.0, sigma);
    std::vector<QuadraticLaw> laws;
    for (std::size_t k = 0; k < ranges.series(); ++k) {
      const FitCell& cell = ranges.cell(leading.range, leading.readings, k);
      const double zero = best_zero(cell, truth[k]);
      VectorXd force(cell.basis.cols());
      for (Index j = 0; j < force.size(); ++j)
        force[j] = truth[k].force.value(std::max(0.0, cell.travel[static_cast<std::size_t>(j)] - zero)) + noise(random);
      laws.push_back(printed_law(cell.travel, force, experiment.series[k].law->r_squared_digits));
    }
    as_far[i] = fit_statistic(ranges.of(laws), likely) <= observed ? 1 : 0;
  });
  return (1.0 + std::accumulate(as_far.begin(), as_far.end(), 0.0)) / (replicates + 1.0);
}

MapOptions coarse_map() {
  MapOptions options;
  options.ranges.ranges = 9;
  options.ranges.readings = {6, 13, 30, 68, 200};
  options.elements = 32;
  options.first = 12, options.batch = 8, options.batches = 2;
  return options;
}

FitRanges fit_ranges(const Experiment& experiment, const MapOptions& options) {
  std::vector<Series> series = experiment.series;
  for (Series& s : series) s.test.travel = {0.0, 1e-4, 2e-4, 3e-4};
  std::vector<double> touch;
  for (const Prediction& p : predict_all(series, experiment.solver)) touch.push_back(p.curve.curve.natural_height);
  return {experiment.series, touch, options.ranges};
}

std::vector<HypothesisMap> published_map(const Experiment& experiment, const FitRanges& ranges,
                                         const std::vector<Hypothesis>& hypotheses, const MapOptions& options) {
  std::vector<HypothesisMap> maps;
  for (const Hypothesis& h : hypotheses) {
    if (options.progress && !options.progress(h.name)) break;
    maps.push_back(map_of(experiment, ranges, h, options));
  }
  for (int prior = 0; prior < 2; ++prior) {
    std::vector<double> all;
    for (const HypothesisMap& m : maps) all.push_back(m.log_evidence[prior]);
    const double sum = log_sum(all);
    for (HypothesisMap& m : maps) m.probability[prior] = std::exp(m.log_evidence[prior] - sum);
  }
  return maps;
}

}  // namespace snare::identification
