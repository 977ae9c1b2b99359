#include "identification/fitting/prediction.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace snare::identification {

namespace {

/// Where a record is computed and how its readings follow from there.
struct Sampling {
  std::vector<double> travel;  // to compute at
  struct Weights {
    std::size_t first = 0;  // of four neighbours
    std::array<double, 4> weight{};
  };
  std::vector<Weights> readings;  // empty: the travels are those of the readings
};

constexpr int points_a_leg = 60;

Sampling sample(const std::vector<double>& d, bool thin) {
  Sampling result;
  result.travel = d;
  if (!thin || d.size() <= dense_leg) return result;
  const std::vector<std::size_t> turns = turning_points(d);
  if (d.size() / (turns.size() - 1) <= dense_leg) return result;
  result.travel.clear();
  for (std::size_t leg = 0; leg + 1 < turns.size(); ++leg) {
    const std::size_t begin = leg == 0 ? 0 : turns[leg] + 1;
    const std::size_t end = turns[leg + 1];
    const auto [low, high] = std::minmax_element(d.begin() + static_cast<std::ptrdiff_t>(turns[leg]),
                                                 d.begin() + static_cast<std::ptrdiff_t>(end) + 1);
    const bool up = d[end] >= d[turns[leg]];
    const double from = up ? *low : *high;
    const double to = up ? *high : *low;
    const std::size_t first = result.travel.size();
    // Denser towards the beginning of the leg, where a wire is touched or friction turns round.
    for (int k = 0; k < points_a_leg; ++k) {
      const double u = static_cast<double>(k) / (points_a_leg - 1);
      result.travel.push_back(from + (to - from) * u * (0.3 + 0.7 * u));
    }
    // Each reading by Lagrange's cubic through the four knots about it, w_a = prod_b (d - d_b) / (d_a - d_b).
    for (std::size_t i = begin; i <= end; ++i) {
      const auto knot = [&](std::size_t k) { return result.travel[first + k]; };
      std::size_t j = 1;
      while (j + 3 < static_cast<std::size_t>(points_a_leg) && (d[i] - knot(j + 1)) * (to - from) > 0.0) ++j;
      Sampling::Weights w;
      w.first = first + j - 1;
      for (std::size_t a = 0; a < 4; ++a) {
        w.weight[a] = 1.0;
        for (std::size_t b = 0; b < 4; ++b) {
          if (b != a) w.weight[a] *= (d[i] - knot(j - 1 + b)) / (knot(j - 1 + a) - knot(j - 1 + b));
        }
      }
      result.readings.push_back(w);
    }
  }
  return result;
}

}  // namespace

Prediction predict(const Series& series, const SolverSettings& solver, const ReadingModel& reading,
                   const PredictionOptions& options) {
  coupling::PushProblem test = series.test;
  const Sampling sampling = sample(true_travel(series, reading), options.thin);
  const std::vector<double>& travel = sampling.travel;
  Prediction result;
  result.reading = reading;
  // Points before the first touch stand at the front; a later return to no contact is part of the path.
  while (result.before_touch < travel.size() && travel[result.before_touch] < 0.0) ++result.before_touch;
  test.travel.assign(travel.begin() + static_cast<std::ptrdiff_t>(result.before_touch), travel.end());
  if (options.stop && options.stop()) {  // of many series some are not begun
    result.curve.curve.report.end(numerics::Termination::interrupted, "interrupted before the first point");
    result.force_by.setZero(0, static_cast<Eigen::Index>(options.variations.size()));
    return result;
  }
  coupling::PushOptions push;
  push.elements = solver.elements;
  push.instability = solver.instability;
  push.shapes_at = options.shapes_at;
  push.progress = options.progress;
  push.stop = options.stop;
  push.examine_out_of_plane = options.examine_out_of_plane;
  push.variations = options.variations;
  push.examine_rates = reading.relaxation_time > 0.0 || options.examine_rates;
  result.curve = solver.extrapolate ? coupling::solve_push_extrapolated(test, push)
                                    : coupling::solve_push_with_path_error(test, push);
  // Points that the path passed between the asked ones (arcs through folds) have no reading.
  std::vector<const coupling::PushPoint*> at(result.before_touch, nullptr);
  for (const coupling::PushPoint& p : result.curve.curve.points) {
    if (at.size() == travel.size()) break;
    if (p.travel == test.travel[at.size() - result.before_touch]) at.push_back(&p);
  }
  const auto numbers = static_cast<Eigen::Index>(options.variations.size());
  const bool whole = at.size() == travel.size();
  const std::size_t readings = sampling.readings.empty() ? at.size() : (whole ? sampling.readings.size() : 0);
  result.wire.force.assign(readings, 0.0);
  result.mount_pull.assign(readings, 0.0);
  if (push.examine_rates) result.wire.viscous.assign(readings, 0.0);
  result.force_by.setZero(static_cast<Eigen::Index>(readings), numbers);
  const auto add = [&](std::size_t i, const coupling::PushPoint* p, double weight) {
    if (p == nullptr) return;
    result.wire.force[i] += weight * p->force;
    result.mount_pull[i] -= weight * p->reaction_along_left;
    if (push.examine_rates) result.wire.viscous[i] += weight * p->viscous_stiffness;
    if (p->force_by.empty()) return;
    result.force_by.row(static_cast<Eigen::Index>(i)) +=
        weight * Eigen::Map<const Eigen::RowVectorXd>(p->force_by.data(), numbers);
  };
  for (std::size_t i = 0; i < readings; ++i) {
    if (sampling.readings.empty()) {
      add(i, at[i], 1.0);
      continue;
    }
    const Sampling::Weights& w = sampling.readings[i];
    for (std::size_t k = 0; k < 4; ++k) add(i, at[w.first + k], w.weight[k]);
  }
  result.force = recorded_force(series, reading, result.wire);
  return result;
}

std::vector<Prediction> predict_all(const std::vector<Series>& series, const SolverSettings& solver,
                                    const ReadingModel& reading,
                                    const std::vector<PredictionOptions>& options) {
  std::vector<Prediction> result(series.size());
  base::parallel_for(series.size(), [&](std::size_t k) {
    result[k] = predict(series[k], solver, reading, options.empty() ? PredictionOptions{} : options[k]);
  });
  return result;
}

std::vector<double> measured_force(const Series& series) {
  if (series.readings) return series.readings->force;
  std::vector<double> force;
  if (series.law) {
    for (const double d : series.test.travel) force.push_back(series.law->force(d));
  }
  return force;
}

Misfit misfit(const std::vector<double>& measured, const std::vector<double>& predicted) {
  Misfit result;
  const std::size_t n = std::min(measured.size(), predicted.size());
  if (n == 0) return result;
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double difference = predicted[i] - measured[i];
    sum += difference * difference;
    result.largest = std::max(result.largest, std::abs(difference));
  }
  result.rmse = std::sqrt(sum / static_cast<double>(n));
  const auto [low, high] = std::minmax_element(measured.begin(), measured.end());
  if (*high > *low) result.nrmse = result.rmse / (*high - *low);
  return result;
}

}  // namespace snare::identification
