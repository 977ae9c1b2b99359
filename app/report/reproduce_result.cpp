#include "app/report/reproduce_result.hpp"

#include <algorithm>
#include <utility>

namespace snare::app {

using identification::Experiment;
using identification::Misfit;
using identification::Prediction;
using identification::Series;

const Prediction* ReproducedModel::at(std::size_t series) const {
  return series < predictions.size() ? &predictions[series] : nullptr;
}

std::optional<Misfit> ReproducedModel::misfit(const Experiment& experiment) const {
  if (predictions.empty()) return std::nullopt;
  std::vector<double> measured, predicted;
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const std::vector<double> force = identification::measured_force(experiment.series[k]);
    const std::vector<double>& computed = predictions[k].force;
    const std::size_t n = std::min(force.size(), computed.size());
    measured.insert(measured.end(), force.begin(), force.begin() + static_cast<std::ptrdiff_t>(n));
    predicted.insert(predicted.end(), computed.begin(), computed.begin() + static_cast<std::ptrdiff_t>(n));
  }
  return identification::misfit(measured, predicted);
}

bool ReproducedModel::complete(const Experiment& experiment) const {
  return predictions.size() == experiment.series.size() &&
         std::ranges::all_of(predictions, [](const Prediction& p) { return reason_stopped(p).empty(); });
}

const ReproducedModel* Reproduction::best_model() const {
  const auto rank = [&](const ReproducedModel& model) {
    return std::pair{!model.complete(experiment), model.misfit(experiment)->rmse};
  };
  const ReproducedModel* best = nullptr;
  for (const ReproducedModel& model : models) {
    if (model.misfit(experiment) && (!best || rank(model) < rank(*best))) best = &model;
  }
  return best;
}

std::string reason_stopped(const Prediction& prediction) {
  const numerics::SolveReport& report = prediction.curve.curve.report;
  return report.usable() ? "" : report.message;
}

std::optional<double> published_scatter(const Series& series) {
  return series.law ? series.law->scatter() : series.force_sigma;
}

std::vector<double> tangent_stiffness(const std::vector<double>& displacement,
                                      const std::vector<double>& force) {
  const std::size_t n = std::min(displacement.size(), force.size());
  std::vector<double> result;
  for (std::size_t i = 0; i < n && n > 1; ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1;
    const std::size_t b = std::min(i + 1, n - 1);
    result.push_back(1e-3 * (force[b] - force[a]) / (displacement[b] - displacement[a]));
  }
  return result;
}

std::vector<double> published_stiffness(const Series& series) {
  const std::vector<double>& displacement = identification::measured_displacement(series);
  if (!series.law) return tangent_stiffness(displacement, identification::measured_force(series));
  std::vector<double> stiffness;
  stiffness.reserve(displacement.size());
  for (const double d : displacement) stiffness.push_back(1e-3 * (2.0 * series.law->a * d + series.law->b));
  return stiffness;
}

double largest_force(const Prediction& prediction) {
  double largest = 0.0;
  for (const double f : prediction.force) largest = std::max(largest, f);
  return largest;
}

}  // namespace snare::app
