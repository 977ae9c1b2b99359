#include "identification/records/motion_fit.hpp"

#include "identification/records/coloured_noise.hpp"
#include "identification/records/simplex.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

constexpr double step_share = 0.1;  ///< of a number's scale: the step of the differences

class MotionResiduals final : public ceres::CostFunction {
 public:
  MotionResiduals(const MotionModel& model, const MotionData& data, const std::vector<MotionSetting>& settings,
                  const std::vector<MotionSetting>& fixed)
      : model_(model), data_(data), settings_(settings), fixed_(fixed) {
    set_num_residuals(static_cast<int>(data.rows));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(settings.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const std::vector<MotionSetting> settings = at(parameters[0]);
    if (last_.empty() || last_at_ != values_of(settings)) {
      last_ = model_.predict(together(settings, fixed_), data_.records);
      last_at_ = values_of(settings);
    }
    const Eigen::VectorXd residual = data_.residual(last_);
    if (residual.size() == 0) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = residual;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor>(jacobians[0], num_residuals(), static_cast<Eigen::Index>(settings.size())) =
          -signal_derivatives(model_, data_, settings, last_, fixed_, Differences::forward);
    }
    return true;
  }

  [[nodiscard]] std::vector<MotionSetting> at(const double* x) const {
    std::vector<MotionSetting> settings = settings_;
    for (std::size_t k = 0; k < settings.size(); ++k) settings[k].value = x[k] * settings[k].number.scale;
    return settings;
  }

 private:
  static std::vector<double> values_of(const std::vector<MotionSetting>& settings) {
    std::vector<double> values;
    for (const MotionSetting& s : settings) values.push_back(s.value);
    return values;
  }

  const MotionModel& model_;
  const MotionData& data_;
  std::vector<MotionSetting> settings_;
  const std::vector<MotionSetting>& fixed_;
  mutable std::vector<RecordPrediction> last_;
  mutable std::vector<double> last_at_;
};

class Observer final : public ceres::IterationCallback {
 public:
  Observer(const MotionModel& model, const MotionFitOptions& options) : model_(model), options_(options) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    const bool go_on = !model_.stopped() && (!options_.progress || options_.progress(s.iteration, 2.0 * s.cost));
    return go_on ? ceres::SOLVER_CONTINUE : ceres::SOLVER_ABORT;
  }

 private:
  const MotionModel& model_;
  const MotionFitOptions& options_;
};

void gauss_newton(const MotionModel& model, const MotionData& data, const MotionFitOptions& options, MotionFit& fit) {
  auto* cost = new MotionResiduals(model, data, fit.settings, options.fixed);  // the problem owns it
  std::vector<double> x;
  for (const MotionSetting& s : fit.settings) x.push_back(s.value / s.number.scale);
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, x.data());
  for (std::size_t k = 0; k < x.size(); ++k) {
    const MotionNumber& n = fit.settings[k].number;
    const int i = static_cast<int>(k);
    if (std::isfinite(n.lower)) problem.SetParameterLowerBound(x.data(), i, n.lower / n.scale);
    if (std::isfinite(n.upper)) problem.SetParameterUpperBound(x.data(), i, n.upper / n.scale);
  }
  Observer observer(model, options);
  ceres::Solver::Options solver;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = 1e-8;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.initial_trust_region_radius = 1e8;  // start and rate of a swing hang together: damping would creep
  solver.logging_type = ceres::SILENT;
  solver.callbacks.push_back(&observer);
  solver.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  fit.settings = cost->at(x.data());
  fit.iterations = static_cast<int>(summary.iterations.size());
  if (summary.termination_type == ceres::USER_FAILURE)
    static_cast<void>(fit.report.end(numerics::Termination::interrupted, "interrupted"));
  else if (summary.termination_type == ceres::FAILURE)
    static_cast<void>(fit.report.end(numerics::Termination::step_too_small, "the fit failed: " + summary.message));
  else if (summary.termination_type == ceres::NO_CONVERGENCE)
    static_cast<void>(
        fit.report.end(numerics::Termination::iteration_limit, "the fit did not converge: " + summary.message));
}

}  // namespace

Eigen::MatrixXd signal_derivatives(const MotionModel& model, const MotionData& data,
                                   const std::vector<MotionSetting>& settings,
                                   const std::vector<RecordPrediction>& base, const std::vector<MotionSetting>& fixed,
                                   Differences differences) {
  std::vector<std::vector<MotionSetting>> points;
  std::vector<std::optional<std::size_t>> only;
  std::vector<std::pair<double, double>> steps;  // down, up
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const MotionNumber& n = settings[k].number;
    const double step = step_share * n.scale;
    const double up = settings[k].value + step <= n.upper ? step : 0.0;
    const bool both = differences == Differences::central || up == 0.0;
    const double down = both && settings[k].value - step >= n.lower ? step : 0.0;
    steps.emplace_back(down, up);
    for (const double move : {-down, up}) {
      if (move == 0.0) continue;
      points.push_back(together(settings, fixed));
      points.back()[k].value += move;
      only.push_back(n.record);
    }
  }
  const auto predictions = model.predict_many(points, data.records, &base, only);
  const Eigen::VectorXd here = data.signal(base);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(data.rows, static_cast<Eigen::Index>(settings.size()));
  std::size_t next = 0;
  for (std::size_t k = 0; k < settings.size(); ++k) {
    auto [down, up] = steps[k];
    Eigen::VectorXd below = down > 0.0 ? data.signal(predictions[next++]) : here;
    Eigen::VectorXd above = up > 0.0 ? data.signal(predictions[next++]) : here;
    if (below.size() == 0) {  // no motion on that side, or no such number
      below = here;
      down = 0.0;
    }
    if (above.size() == 0) {
      above = here;
      up = 0.0;
    }
    if (down + up == 0.0) continue;
    columns.col(static_cast<Eigen::Index>(k)) = (above - below) * (settings[k].number.scale / (down + up));
  }
  return columns;
}

MotionFit fit_motion(const MotionModel& model, const MotionData& data, std::vector<MotionSetting> start,
                     const MotionFitOptions& options) {
  MotionFit fit;
  const long before = model.simulations();
  fit.settings = std::move(start);
  if (!fit.settings.empty()) {
    if (options.method == FitMethod::nelder_mead)
      nelder_mead(model, data, options, fit);
    else
      gauss_newton(model, data, options, fit);
  }
  fit.simulations = model.simulations() - before;
  fit.predictions = model.predict(together(fit.settings, options.fixed), data.records);
  fit.residual = data.residual(fit.predictions);
  std::string why;
  for (const RecordPrediction& p : fit.predictions)
    if (!p.usable()) why = p.failure;
  if (!why.empty()) {
    static_cast<void>(
        fit.report.end(model.stopped() ? numerics::Termination::interrupted : numerics::Termination::step_too_small,
                       model.stopped() ? "interrupted" : "the scenario cannot be simulated: " + why));
    fit.chi2 = std::numeric_limits<double>::max();
    return fit;
  }
  fit.chi2 = fit.residual.squaredNorm();
  if (options.derivatives && data.rows > 0 && !model.stopped()) {
    fit.jacobian = signal_derivatives(model, data, fit.settings, fit.predictions, options.fixed);
    const ColouredNoise noise = coloured_noise(data, fit.residual);
    fit.covariance = sandwich(data, noise, fit.jacobian);
    for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i)
      for (Eigen::Index j = 0; j < fit.covariance.cols(); ++j)
        fit.covariance(i, j) *= fit.settings[static_cast<std::size_t>(i)].number.scale *
                                fit.settings[static_cast<std::size_t>(j)].number.scale;
  }
  return fit;
}

}  // namespace snare::identification
