#include "identification/published/published_map.hpp"

#include "base/parallel.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/prediction.hpp"
#include "identification/published/importance_sampling.hpp"
#include "identification/published/range_profile.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

namespace snare::identification {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

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
std::vector<TouchCurve> touch_curves(const std::vector<Prediction>& predictions,
                                     const std::vector<Series>& series) {
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

/// Logarithm of the prior of a decimal point that slipped, times the density of the printed coefficient over
/// that of the fitted one: a coefficient that is divided by 100 has 100 times the density.
double log_density_of_print(const Hypothesis& hypothesis) {
  return hypothesis.decimal_point ? std::log(100.0 * prior_of_a_slip) : 0.0;
}

/// log p of a published fit whose parabola is exact, with a scatter of its own.
double of_parabola(const FitCell& cell) {
  const auto components = static_cast<double>(cell.basis.cols() - 3);
  return length_probability(cell.numbers.lower, cell.numbers.upper, components, 0.0, cell.log_scatter).log -
         3.0 * cell.log_scatter + cell.log_scale;
}

/// The largest log p over ranges and numbers of readings if every published parabola were exact.
double of_parabolas(const FitRanges& ranges) {
  double best = impossible;
  for (std::size_t n = 0; n < ranges.readings().size(); ++n) {
    double own = 0.0;
    for (std::size_t k = 0; k < ranges.series(); ++k) {
      double largest = impossible;
      for (const FitCells& edge : ranges.edges()) largest = std::max(largest, of_parabola(edge.cell(n, k)));
      own += largest;
    }
    best = std::max(best, own);
    for (const FitCells& cells : ranges.taut()) {
      double sum = 0.0;
      for (std::size_t k = 0; k < ranges.series(); ++k) sum += of_parabola(cells.cell(n, k));
      best = std::max(best, sum);
    }
  }
  return best;
}

/// T of published_p.
double fit_statistic(const FitRanges& ranges, const std::vector<std::vector<TouchCurve>>& likely) {
  double best = impossible;
  for (const std::vector<TouchCurve>& curves : likely)
    best = std::max(best, range_profile(ranges, curves, best - std::log(scatter_step * scatters)).largest);
  return best - of_parabolas(ranges);
}

/// One hypothesis: its test as a function of its numbers.
class Computed {
 public:
  Computed(const Experiment& experiment, const FitRanges& ranges, const Hypothesis& hypothesis, int elements)
      : hypothesis_(hypothesis),
        model_(pushes(experiment, ranges, hypothesis), solver(experiment, elements)) {}

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

/// Computed tests of one hypothesis, drawn by their evidence.
class HypothesisSampling {
 public:
  /// leading: the largest log p of the hypotheses before.
  HypothesisSampling(const Experiment& experiment, const FitRanges& ranges, const Hypothesis& hypothesis,
                     const MapOptions& options, double leading)
      : hypothesis_(hypothesis),
        ranges_(ranges.of(before_print(ranges.laws(), hypothesis))),
        computed_(experiment, ranges, hypothesis_, options.elements),
        columns_(ranges.readings().size()),
        batch_(options.batch * static_cast<int>(hypothesis.numbers.size())),
        leading_(leading),
        sampler_(static_cast<Index>(hypothesis.numbers.size()),
                 options.first * static_cast<int>(hypothesis.numbers.size()),
                 [this](const std::vector<VectorXd>& points) { return integrand(points); }) {}
  HypothesisSampling(const HypothesisSampling&) = delete;
  HypothesisSampling& operator=(const HypothesisSampling&) = delete;

  void add_batch() {
    sampler_.add_batch(batch_);
    ++batches_;
  }
  [[nodiscard]] const Hypothesis& hypothesis() const { return hypothesis_; }
  [[nodiscard]] double log_evidence() const { return sampler_.log_integral(); }
  [[nodiscard]] double effective() const { return sampler_.effective(); }
  [[nodiscard]] int batches() const { return batches_; }
  [[nodiscard]] double largest() const { return best_; }
  [[nodiscard]] HypothesisMap map() const;

 private:
  /// log p of a computed test over all ranges, even in their logarithm or in themselves.
  [[nodiscard]] double over_ranges(std::size_t test, bool uniform) const {
    std::vector<double> terms(logs_[test].size());
    for (std::size_t c = 0; c < terms.size(); ++c)
      terms[c] = std::log(ranges_.mass(c / columns_, uniform)) + logs_[test][c];
    return log_sum(terms);
  }
  std::vector<double> integrand(const std::vector<VectorXd>& points) {
    constexpr double nothing = 30.0,
                     out_of_question = 40.0;  // of the logarithm: of the best so far, of the leading one
    const double floor = std::max(best_ - nothing, leading_ - out_of_question);
    const std::size_t before = logs_.size();
    logs_.resize(before + points.size());
    values_.resize(logs_.size());
    best_to_.resize(logs_.size());
    std::vector<double> largest(points.size());
    base::parallel_for(points.size(), [&](std::size_t i) {
      values_[before + i] = computed_.values(points[i]);
      RangeProfile profile = range_profile(ranges_, computed_.curves(values_[before + i]),
                                           floor - log_density_of_print(hypothesis_));
      for (double& log : profile.log) log += log_density_of_print(hypothesis_);
      logs_[before + i] = std::move(profile.log);
      best_to_[before + i] = std::move(profile.best_to);
      largest[i] = profile.largest + log_density_of_print(hypothesis_);
    });
    std::vector<double> result;
    for (std::size_t i = before; i < logs_.size(); ++i) {
      result.push_back(over_ranges(i, false));
      best_ = std::max(best_, largest[i - before]);
    }
    return result;
  }
  [[nodiscard]] std::vector<std::vector<double>> likely(const MapCell& leading) const;

  Hypothesis hypothesis_;
  FitRanges ranges_;
  Computed computed_;
  std::size_t columns_;
  int batch_, batches_ = 0;
  std::vector<std::vector<double>> logs_, values_;         // one a computed test
  std::vector<std::vector<std::vector<double>>> best_to_;  // likewise, by range and number of readings
  double leading_, best_ = impossible;
  ImportanceSampler sampler_;
};

HypothesisMap HypothesisSampling::map() const {
  HypothesisMap map{.hypothesis = hypothesis_, .cells = {}, .posterior = {}, .likely = {}};
  map.effective = effective();
  const std::vector<double>& log_weight = sampler_.points().log_weight;
  std::vector<double> evidence[2];
  for (std::size_t c = 0; c < logs_.front().size(); ++c) {
    std::vector<double> terms;
    std::size_t best = 0;
    for (std::size_t s = 0; s < logs_.size(); ++s) {
      terms.push_back(log_weight[s] + logs_[s][c]);
      if (logs_[s][c] > logs_[best][c]) best = s;
    }
    const FitRange& range = ranges_.ranges()[c / columns_];
    const std::vector<double>& to = best_to_[best][c];
    MapCell cell{c / columns_,   c % columns_,  log_sum(terms),
                 logs_[best][c], values_[best], to.empty() ? range.to : to};
    for (int prior = 0; prior < 2; ++prior)
      evidence[prior].push_back(cell.log_evidence + std::log(ranges_.mass(cell.range, prior == 1)));
    map.cells.push_back(std::move(cell));
  }
  for (int prior = 0; prior < 2; ++prior) map.log_evidence[prior] = log_sum(evidence[prior]);
  constexpr double nothing = 15.0;  // e^-15 of the evidence
  for (std::size_t s = 0; s < logs_.size(); ++s) {
    PosteriorPoint point{values_[s],
                         {log_weight[s] + over_ranges(s, false), log_weight[s] + over_ranges(s, true)}};
    if (point.log_weight[0] > map.log_evidence[0] - nothing ||
        point.log_weight[1] > map.log_evidence[1] - nothing)
      map.posterior.push_back(std::move(point));
  }
  map.likely = likely(leading_cell(map, ranges_));
  return map;
}

/// Values of the computed tests that are the likeliest at a range and a number of readings.
std::vector<std::vector<double>> HypothesisSampling::likely(const MapCell& leading) const {
  const std::size_t at = leading.range * columns_ + leading.readings;
  std::vector<std::size_t> order(logs_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t s) { return logs_[s][at]; });
  constexpr std::size_t most_likely = 6;
  std::vector<std::vector<double>> result;
  for (std::size_t i = 0; i < std::min(most_likely, order.size()); ++i) result.push_back(values_[order[i]]);
  return result;
}

}  // namespace

std::vector<TouchCurve> computed_curves(const Experiment& experiment, const FitRanges& ranges,
                                        const Hypothesis& hypothesis, const std::vector<double>& values,
                                        int elements) {
  return Computed(experiment, ranges, hypothesis, elements).curves(values);
}

const MapCell& leading_cell(const HypothesisMap& map, const FitRanges& ranges) {
  return *std::ranges::max_element(map.cells, {}, [&](const MapCell& c) {
    return c.log_evidence + std::log(ranges.mass(c.range, false));
  });
}

double published_p(const Experiment& experiment, const FitRanges& printed, const HypothesisMap& map,
                   const MapOptions& options, int replicates) {
  const FitRanges ranges = printed.of(before_print(printed.laws(), map.hypothesis));
  const Computed computed(experiment, ranges, map.hypothesis, options.elements);
  std::vector<std::vector<TouchCurve>> likely;
  for (const std::vector<double>& values : map.likely) likely.push_back(computed.curves(values));
  const MapCell& leading = leading_cell(map, ranges);
  const FitCells cells = ranges.at(leading.to);
  const std::vector<TouchCurve>& truth = likely.front();
  std::vector<std::optional<double>> zeros(truth.size());
  const ByScatter scatter = by_scatter(cells, leading.readings, truth, zeros, impossible);
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
      const FitCell& cell = cells.cell(leading.readings, k);
      const double zero = *zeros[k];
      VectorXd force(cell.basis.cols());
      for (Index j = 0; j < force.size(); ++j)
        force[j] = truth[k].force.value(std::max(0.0, cell.travel[static_cast<std::size_t>(j)] - zero)) +
                   noise(random);
      laws.push_back(printed_law(cell.travel, force, experiment.series[k].law->r_squared_digits));
    }
    as_far[i] = fit_statistic(ranges.of(laws), likely) <= observed ? 1 : 0;
  });
  return (1.0 + std::accumulate(as_far.begin(), as_far.end(), 0.0)) / (replicates + 1.0);
}

MapOptions coarse_map() {
  MapOptions options;
  options.ranges.bins = 8;
  options.ranges.readings = {6, 13, 30, 100};
  options.elements = 32;
  options.first = 10, options.batch = 8, options.batches = 2;
  options.effective = 10.0, options.most_batches = 8;
  return options;
}

FitRanges fit_ranges(const Experiment& experiment, const MapOptions& options) {
  std::vector<Series> series = experiment.series;
  for (Series& s : series) s.test.travel = {0.0, 1e-4, 2e-4, 3e-4};
  std::vector<double> touch;
  for (const Prediction& p : predict_all(series, experiment.solver))
    touch.push_back(p.curve.curve.natural_height);
  return {experiment.series, touch, options.ranges};
}

std::vector<HypothesisMap> published_map(const Experiment& experiment, const FitRanges& ranges,
                                         const std::vector<Hypothesis>& hypotheses,
                                         const MapOptions& options) {
  // of the logarithm of the evidence: hypotheses farther behind need no precision
  constexpr double rival = 12.0;
  bool stopped = false;
  double leading = impossible;
  const auto goes_on = [&](const std::string& stage) {
    stopped = stopped || (options.progress && !options.progress(stage));
    return !stopped;
  };
  std::deque<HypothesisSampling> all;
  for (const Hypothesis& h : hypotheses) {
    if (!goes_on(h.name)) break;
    HypothesisSampling& one = all.emplace_back(experiment, ranges, h, options, leading);
    for (int b = 0; b < options.batches; ++b) one.add_batch();
    leading = std::max(leading, one.largest());
  }
  for (bool added = true; added;) {
    added = false;
    double best = impossible;
    for (const HypothesisSampling& h : all) best = std::max(best, h.log_evidence());
    for (HypothesisSampling& h : all) {
      if (h.log_evidence() < best - rival || h.effective() >= options.effective ||
          h.batches() >= options.most_batches || !goes_on("more of " + h.hypothesis().name))
        continue;
      h.add_batch();
      added = true;
    }
  }
  std::vector<HypothesisMap> maps;
  for (const HypothesisSampling& h : all) maps.push_back(h.map());
  for (int prior = 0; prior < 2; ++prior) {
    std::vector<double> all;
    for (const HypothesisMap& m : maps) all.push_back(m.log_evidence[prior]);
    const double sum = log_sum(all);
    for (HypothesisMap& m : maps) m.probability[prior] = std::exp(m.log_evidence[prior] - sum);
  }
  return maps;
}

}  // namespace snare::identification
