#include "identification/records/record_fit.hpp"

#include "identification/records/bounded_least_squares.hpp"
#include "identification/records/coloured_noise.hpp"
#include "identification/records/simplex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace snare::identification {

namespace {

constexpr double step_share = 0.1;  ///< of a number's scale: the step of the differences

/// Step of the differences by a number. For central ones a number that has grown far beyond its declared
/// value is moved in
/// proportion: a smaller step would show the errors of the integration alone. Forward ones would be off by
/// the longer step.
double step_of(const RecordSetting& s, Differences differences) {
  const bool follows = s.number.scale_follows && differences == Differences::central;
  return step_share * (follows ? std::max(s.number.scale, 0.01 * std::abs(s.value)) : s.number.scale);
}

/// Takes derivatives by numbers that hardly act again, with a long step: a short one shows the errors of the
/// integration. The column of a number that does not act with a long step either becomes zero, and the number
/// stays where it is.
void retake_weak_columns(const RecordModel& model, const RecordData& data,
                         const std::vector<RecordSetting>& settings,
                         const std::vector<RecordPrediction>& base, const std::vector<RecordSetting>& fixed,
                         Eigen::MatrixXd& jacobian) {
  // Changes of the whole residual in standard deviations; a scale is 1 % of a declared number.
  constexpr double weak = 0.02;       // by a scale
  constexpr double long_step = 50.0;  // scales
  constexpr double nothing = 0.1;     // by the long step
  std::vector<RecordSetting> weak_ones, rest = fixed;
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = 0; k < jacobian.cols(); ++k) {
    const double norm = jacobian.col(k).norm();
    const bool again = norm < weak && norm > 0.0;
    if (again) columns.push_back(k);
    (again ? weak_ones : rest).push_back(settings[static_cast<std::size_t>(k)]);
  }
  if (columns.empty()) return;
  jacobian(Eigen::all, columns) =
      signal_derivatives(model, data, weak_ones, base, rest, Differences::forward, long_step / step_share);
  for (const Eigen::Index k : columns)
    if (jacobian.col(k).norm() * long_step < nothing) jacobian.col(k).setZero();
}

void gauss_newton(const RecordModel& model, const RecordData& data, const RecordFitOptions& options,
                  RecordFit& fit) {
  const auto count = static_cast<Eigen::Index>(fit.settings.size());
  Eigen::VectorXd start(count);
  BoundedProblem problem;
  problem.lower = problem.upper = Eigen::VectorXd::Zero(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const RecordSetting& s = fit.settings[static_cast<std::size_t>(k)];
    start[k] = s.value / s.number.scale;
    problem.lower[k] = s.number.lower / s.number.scale;
    problem.upper[k] = s.number.upper / s.number.scale;
  }
  // A bound comes back exactly: a number beside it by rounding would be refused.
  const auto at = [&](const Eigen::VectorXd& x) {
    std::vector<RecordSetting> settings = fit.settings;
    for (Eigen::Index k = 0; k < count; ++k) {
      RecordSetting& s = settings[static_cast<std::size_t>(k)];
      s.value = std::clamp(x[k] * s.number.scale, s.number.lower, s.number.upper);
    }
    return settings;
  };
  std::vector<RecordPrediction> last;
  Eigen::VectorXd last_at;
  problem.residual = [&](const Eigen::VectorXd& x) {
    last = model.predict(together(at(x), options.fixed), data.records, data.readings);
    last_at = x;
    return data.residual(last);
  };
  problem.residual_jacobian = [&](const Eigen::VectorXd& x) -> Eigen::MatrixXd {
    const std::vector<RecordSetting> settings = at(x);
    if (last_at != x) last = model.predict(together(settings, options.fixed), data.records, data.readings);
    Eigen::MatrixXd derivatives =
        signal_derivatives(model, data, settings, last, options.fixed, Differences::forward);
    retake_weak_columns(model, data, settings, last, options.fixed, derivatives);
    return -derivatives;
  };
  problem.progress = [&](int iteration, double chi2) {
    return !model.stopped() && (!options.progress || options.progress(iteration, chi2));
  };
  problem.by_chance = static_cast<double>(count) / std::max(1.0, static_cast<double>(data.rows));
  problem.first_jacobian = -options.first_jacobian;
  const BoundedResult result =
      bounded_least_squares(problem, start, options.max_iterations, options.tolerance);
  fit.settings = at(result.x);
  fit.jacobian = -result.jacobian;
  fit.iterations = result.iterations;
  if (result.end == BoundedEnd::stopped)
    static_cast<void>(fit.report.end(numerics::Termination::interrupted, "interrupted"));
  else if (result.end == BoundedEnd::iteration_limit)
    static_cast<void>(fit.report.end(numerics::Termination::iteration_limit, "the fit did not converge"));
}

}  // namespace

namespace {

/// What a number's steps down and up lead to.
struct Beside {
  double down = 0.0, up = 0.0;   // 0: no step to that side
  Eigen::VectorXd below, above;  // signals there; empty: none
};

/// Signals beside `settings` for the numbers of which a step is asked; a step that nothing can be simulated
/// at has none.
void take_steps(const RecordModel& model, const RecordData& data, const std::vector<RecordSetting>& settings,
                const std::vector<RecordPrediction>& base, const std::vector<RecordSetting>& fixed,
                std::vector<Beside>& beside) {
  std::vector<std::vector<RecordSetting>> points;
  std::vector<std::optional<std::size_t>> only;
  for (std::size_t k = 0; k < settings.size(); ++k) {
    for (const double move : {-beside[k].down, beside[k].up}) {
      if (move == 0.0) continue;
      points.push_back(together(settings, fixed));
      points.back()[k].value += move;
      only.push_back(settings[k].number.record);
    }
  }
  const auto predictions = model.predict_many(points, data.records, data.readings, &base, only);
  std::size_t next = 0;
  for (Beside& b : beside) {
    if (b.down > 0.0) b.below = data.signal(predictions[next++]);
    if (b.up > 0.0) b.above = data.signal(predictions[next++]);
    if (b.below.size() == 0) b.down = 0.0;
    if (b.above.size() == 0) b.up = 0.0;
  }
}

}  // namespace

Eigen::MatrixXd signal_derivatives(const RecordModel& model, const RecordData& data,
                                   const std::vector<RecordSetting>& settings,
                                   const std::vector<RecordPrediction>& base,
                                   const std::vector<RecordSetting>& fixed, Differences differences,
                                   double widen) {
  std::vector<Beside> beside(settings.size());
  const auto step_down = [&](std::size_t k) {
    const double step = widen * step_of(settings[k], differences);
    return settings[k].value - step >= settings[k].number.lower ? step : 0.0;
  };
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const double step = widen * step_of(settings[k], differences);
    if (settings[k].value + step <= settings[k].number.upper) beside[k].up = step;
    if (differences == Differences::central || beside[k].up == 0.0) beside[k].down = step_down(k);
  }
  take_steps(model, data, settings, base, fixed, beside);
  // Forward of a number nothing may move, as where a body would begin inside a wire.
  std::vector<Beside> backward(settings.size());
  bool again = false;
  for (std::size_t k = 0; k < settings.size(); ++k) {
    if (beside[k].down + beside[k].up > 0.0 || differences == Differences::central) continue;
    backward[k].down = step_down(k);
    again = again || backward[k].down > 0.0;
  }
  if (again) take_steps(model, data, settings, base, fixed, backward);
  const Eigen::VectorXd here = data.signal(base);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(data.rows, static_cast<Eigen::Index>(settings.size()));
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const Beside& b = beside[k].down + beside[k].up > 0.0 ? beside[k] : backward[k];
    if (b.down + b.up == 0.0) continue;
    const Eigen::VectorXd change = (b.up > 0.0 ? b.above : here) - (b.down > 0.0 ? b.below : here);
    columns.col(static_cast<Eigen::Index>(k)) = change * (settings[k].number.scale / (b.down + b.up));
  }
  return columns;
}

RecordFit fit_motion(const RecordModel& model, const RecordData& data, std::vector<RecordSetting> start,
                     const RecordFitOptions& options) {
  RecordFit fit;
  const long before = model.simulations();
  fit.settings = std::move(start);
  if (!fit.settings.empty()) {
    if (options.method == FitMethod::nelder_mead)
      nelder_mead(model, data, options, fit);
    else
      gauss_newton(model, data, options, fit);
  }
  fit.simulations = model.simulations() - before;
  fit.predictions = model.predict(together(fit.settings, options.fixed), data.records, data.readings);
  fit.residual = data.residual(fit.predictions);
  std::string why;
  for (const RecordPrediction& p : fit.predictions)
    if (!p.usable()) why = p.failure;
  if (!why.empty()) {
    static_cast<void>(fit.report.end(
        model.stopped() ? numerics::Termination::interrupted : numerics::Termination::step_too_small,
        model.stopped() ? "interrupted" : "the scenario cannot be simulated: " + why));
    fit.chi2 = std::numeric_limits<double>::max();
    return fit;
  }
  fit.chi2 = fit.residual.squaredNorm();
  const auto numbers = static_cast<Eigen::Index>(fit.settings.size());
  if (options.derivatives != FitDerivatives::last && data.rows > 0 && !model.stopped()) {
    if (options.derivatives == FitDerivatives::central || fit.jacobian.cols() != numbers)
      fit.jacobian = signal_derivatives(model, data, fit.settings, fit.predictions, options.fixed);
    const ColouredNoise noise = coloured_noise(data, fit.residual, fit.jacobian.cols());
    fit.covariance = sandwich(data, noise, fit.jacobian);
    for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i)
      for (Eigen::Index j = 0; j < fit.covariance.cols(); ++j)
        fit.covariance(i, j) *= fit.settings[static_cast<std::size_t>(i)].number.scale *
                                fit.settings[static_cast<std::size_t>(j)].number.scale;
  }
  return fit;
}

}  // namespace snare::identification
