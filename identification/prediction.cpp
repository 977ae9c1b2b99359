#include "identification/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>

namespace snare::identification {

Prediction predict(const Series& series, const SolverSettings& solver, const ReadingModel& reading,
                   const PredictionOptions& options) {
  coupling::PushTest test = series.test;
  const std::vector<double>& displacement = measured_displacement(series);
  Prediction result;
  result.reading = reading;
  // Points before the first touch stand at the front; a later return to no contact is part of the path.
  while (result.before_touch < displacement.size() &&
         displacement[result.before_touch] < reading.displacement_offset) {
    ++result.before_touch;
  }
  test.travel.clear();
  for (std::size_t i = result.before_touch; i < displacement.size(); ++i) {
    test.travel.push_back(displacement[i] - reading.displacement_offset);
  }
  coupling::PushOptions push;
  push.elements = solver.elements;
  push.instability = solver.instability;
  push.shapes_at = options.shapes_at;
  push.progress = options.progress;
  push.examine_out_of_plane = options.examine_out_of_plane;
  if (solver.extrapolate) {
    result.curve = coupling::solve_push_extrapolated(test, push);
  } else {
    result.curve.curve = coupling::solve_push(test, push);
    result.curve.discretisation_error.assign(result.curve.curve.points.size(), 0.0);
  }
  result.force.assign(result.before_touch, reading.force_offset);
  // Points that the path passed between the asked ones (arcs through folds) have no reading.
  std::size_t wanted = 0;
  for (const coupling::PushPoint& p : result.curve.curve.points) {
    if (wanted == test.travel.size()) break;
    if (p.travel != test.travel[wanted]) continue;
    result.force.push_back(reading.force_gain * p.force + reading.force_offset);
    ++wanted;
  }
  return result;
}

std::vector<Prediction> predict_all(const std::vector<Series>& series, const SolverSettings& solver,
                                    const ReadingModel& reading, const std::vector<PredictionOptions>& options) {
  std::vector<Prediction> result(series.size());
  std::exception_ptr failure;
  const auto count = static_cast<std::ptrdiff_t>(series.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    try {
      result[k] = predict(series[k], solver, reading, options.empty() ? PredictionOptions{} : options[k]);
    } catch (...) {
#pragma omp critical(snare_predict_all)
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
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

const std::vector<double>& measured_displacement(const Series& series) {
  return series.readings ? series.readings->displacement : series.test.travel;
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
