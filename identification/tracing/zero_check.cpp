#include "identification/tracing/zero_check.hpp"

#include "base/units.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/statistics.hpp"
#include "identification/tracing/projection.hpp"
#include "identification/tracing/remainder.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

constexpr const char* zero_key = "reading.displacement_offset_mm";
constexpr double asked = 0.01;       // P below which the readings ask for a zero
constexpr double worthwhile = 0.05;  // change of a fitted number that an engineer must know of

bool has_zero(const Fit& fit) {
  return std::any_of(fit.settings.begin(), fit.settings.end(),
                     [](const Setting& s) { return s.parameter->key.ends_with(zero_key); });
}

/// The number that changes most as a share of itself.
void compare(const Model& model, const Fit& without, const Fit& with, ZeroCheck& result) {
  double largest = 0.0;
  for (std::size_t k = 0; k < without.free; ++k) {
    const Parameter& p = *without.settings[k].parameter;
    if (p.parametrisation == Parametrisation::shift) continue;
    const double a = model.shown(without.settings[k]);
    const double b = model.shown(with.settings[k]);
    const double change = std::abs(b / a - 1.0);
    if (!(change > largest)) continue;
    largest = change;
    result.key = p.key;
    result.unit = p.unit;
    result.without = a;
    result.with = b;
  }
  result.doubtful = result.p < asked && largest > worthwhile;
}

/// Of the weighed forces by one number more, without what the fitted ones account for; nothing where the
/// model fails.
std::optional<Eigen::VectorXd> column_beside(const Model& model, const Data& data, const Fit& fit,
                                             const Parameter& number) {
  const Evaluation at = model.evaluate(fit.settings, {&number});
  if (!at.complete) return std::nullopt;
  return Projection(fit.jacobian).without(data.jacobian(at).col(0));
}

}  // namespace

std::optional<ZeroCheck> check_zero(const Model& model, const Data& data, const Fit& fit_without) {
  const bool read = std::any_of(data.series.begin(), data.series.end(),
                                [&](std::size_t k) { return !data.noise.summarised(k); });
  if (!read || has_zero(fit_without) || fit_without.dof() < 2.0) return std::nullopt;
  const Parameter& zero = parameters().at(zero_key);
  const std::optional<Eigen::VectorXd> asked_for = column_beside(model, data, fit_without, zero);
  if (!asked_for) return std::nullopt;
  const Eigen::VectorXd& g = *asked_for;
  const double norm = g.norm();
  if (!(norm > 0.0)) return std::nullopt;
  // What is left beside the noise makes every number as uncertain as it makes the residual large.
  const double inflation = std::sqrt(remainder(model, data, fit_without).inflation());
  ZeroCheck result;
  result.p = 2.0 * student_tail(std::abs(g.dot(fit_without.residual)) / norm / inflation, data.noise.dof);
  std::vector<Setting> start = fit_without.fitted();
  start.push_back(
      {&zero, std::clamp(g.dot(fit_without.residual) / (norm * norm), model.lower(zero), model.upper(zero))});
  FitOptions fitting;
  fitting.max_iterations = 15;
  const Fit with = fit(model, data, start, fit_without.fixed(), fitting);
  if (!with.report.usable()) return std::nullopt;
  const auto last = static_cast<Eigen::Index>(with.free) - 1;
  const double offset = with.settings[with.free - 1].coordinate;
  const double deviation = inflation * std::sqrt(std::max(0.0, with.covariance(last, last)));
  result.offset = offset / base::mm;
  result.lower = (offset - 1.96 * deviation) / base::mm;
  result.upper = (offset + 1.96 * deviation) / base::mm;
  compare(model, fit_without, with, result);
  return result;
}

}  // namespace snare::identification
