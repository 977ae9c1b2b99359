#include "identification/calibration.hpp"

#include "numerics/errors.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace snare::identification {

namespace {

/// What a key means: its unit, how it reads from and writes to the models, how far it may go.
struct KeyMeaning {
  const char* key;
  const char* unit;
  double (*get)(const Series&);
  void (*set)(double, Series&, ReadingModel&);
  double (*lower)(const Series&);
  double (*upper)(const Series&);
};

const std::array<KeyMeaning, 6> meanings{{
    {"wire.bending_stiffness_Nm2", "N m^2", [](const Series& s) { return s.test.wire.bending_stiffness(); },
     [](double v, Series& s, ReadingModel&) { s.test.wire.bending_stiffness_override = v; },
     // From a rope of free hairs to twice the solid section.
     [](const Series& s) { return 1e-4 * s.test.wire.bending_stiffness(); },
     [](const Series& s) { return 2.0 * s.test.wire.bending_stiffness(); }},
    {"wire.axial_stiffness_N", "N", [](const Series& s) { return s.test.wire.axial_stiffness(); },
     [](double v, Series& s, ReadingModel&) { s.test.wire.axial_stiffness_override = v; },
     [](const Series& s) { return 1e-3 * s.test.wire.axial_stiffness(); },
     [](const Series& s) { return 2.0 * s.test.wire.axial_stiffness(); }},
    {"wire.length_mm", "mm", [](const Series& s) { return 1e3 * s.test.wire.length; },
     [](double v, Series& s, ReadingModel&) { s.test.wire.length = 1e-3 * v; },
     [](const Series& s) { return 0.99e3 * s.test.mount.span; },
     [](const Series& s) { return 1.2e3 * s.test.mount.span; }},
    {"reading.displacement_offset_mm", "mm", [](const Series&) { return 0.0; },
     [](double v, Series&, ReadingModel& r) { r.displacement_offset = 1e-3 * v; },
     [](const Series&) { return -5.0; }, [](const Series&) { return 5.0; }},
    {"reading.force_offset_N", "N", [](const Series&) { return 0.0; },
     [](double v, Series&, ReadingModel& r) { r.force_offset = v; }, [](const Series&) { return -1e3; },
     [](const Series&) { return 1e3; }},
    {"reading.force_gain", "", [](const Series&) { return 1.0; },
     [](double v, Series&, ReadingModel& r) { r.force_gain = v; }, [](const Series&) { return 0.2; },
     [](const Series&) { return 5.0; }},
}};

const KeyMeaning& meaning_of(const std::string& key) {
  for (const KeyMeaning& m : meanings) {
    if (key == m.key) return m;
  }
  std::string known;
  for (const KeyMeaning& m : meanings) known += (known.empty() ? "" : ", ") + std::string(m.key);
  throw numerics::InputError({"", 0, "fit.free", '"' + key + '"', "must be one of " + known});
}

/// Positive quantities that span decades are fitted by their logarithm.
bool by_logarithm(const std::string& key) { return key.find("stiffness") != std::string::npos; }

/// The experiment as a function of scaled unknowns.
class Objective {
 public:
  Objective(const Experiment& experiment, std::vector<FreeParameter> parameters)
      : experiment_(experiment), parameters_(std::move(parameters)) {
    for (const Series& s : experiment.series) {
      const std::vector<double> force = measured_force(s);
      measured_.insert(measured_.end(), force.begin(), force.end());
    }
  }

  [[nodiscard]] const std::vector<double>& measured() const { return measured_; }
  [[nodiscard]] int count() const { return static_cast<int>(parameters_.size()); }
  int evaluations = 0;

  [[nodiscard]] double to_unknown(int k, double value) const {
    return by_logarithm(parameters_[static_cast<std::size_t>(k)].key) ? std::log(value) : value;
  }
  [[nodiscard]] double to_value(int k, double unknown) const {
    return by_logarithm(parameters_[static_cast<std::size_t>(k)].key) ? std::exp(unknown) : unknown;
  }

  struct Result {
    std::vector<Prediction> predictions;
    ReadingModel reading;
    std::vector<double> force;  // aligned with measured(); empty when a solve failed
  };
  Result evaluate(const double* unknowns, const SolverSettings& solver) {
    ++evaluations;
    Result result;
    std::vector<Series> series = experiment_.series;
    for (int k = 0; k < count(); ++k) {
      apply_parameter(parameters_[static_cast<std::size_t>(k)].key, to_value(k, unknowns[k]), series, result.reading);
    }
    result.predictions = predict_all(series, solver, result.reading);
    for (std::size_t i = 0; i < series.size(); ++i) {
      const std::size_t wanted = measured_displacement(series[i]).size();
      if (result.predictions[i].force.size() != wanted) {
        result.force.clear();
        return result;
      }
      result.force.insert(result.force.end(), result.predictions[i].force.begin(), result.predictions[i].force.end());
    }
    return result;
  }

 private:
  const Experiment& experiment_;
  std::vector<FreeParameter> parameters_;
  std::vector<double> measured_;
};

/// Residuals and central-difference Jacobian for Ceres.
class ForceCost final : public ceres::CostFunction {
 public:
  ForceCost(Objective& objective, const SolverSettings& solver) : objective_(objective), solver_(solver) {
    set_num_residuals(static_cast<int>(objective.measured().size()));
    mutable_parameter_block_sizes()->push_back(objective.count());
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const int n = objective_.count();
    const auto rows = objective_.measured().size();
    const std::vector<double> force = objective_.evaluate(parameters[0], solver_).force;
    if (force.size() != rows) return false;
    for (std::size_t i = 0; i < rows; ++i) residuals[i] = force[i] - objective_.measured()[i];
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    std::vector<double> at(parameters[0], parameters[0] + n);
    for (int k = 0; k < n; ++k) {
      const auto c = static_cast<std::size_t>(k);
      const double centre = at[c];
      const double h = 1e-4 * std::max(0.1, std::abs(centre));
      at[c] = centre + h;
      const std::vector<double> up = objective_.evaluate(at.data(), solver_).force;
      at[c] = centre - h;
      const std::vector<double> down = objective_.evaluate(at.data(), solver_).force;
      at[c] = centre;
      for (std::size_t i = 0; i < rows; ++i) {
        double slope = 0.0;
        if (up.size() == rows && down.size() == rows) slope = (up[i] - down[i]) / (2.0 * h);
        else if (up.size() == rows) slope = (up[i] - force[i]) / h;
        else if (down.size() == rows) slope = (force[i] - down[i]) / h;
        else return false;
        jacobians[0][i * static_cast<std::size_t>(n) + c] = slope;
      }
    }
    return true;
  }

 private:
  Objective& objective_;
  SolverSettings solver_;
};

class Observer final : public ceres::IterationCallback {
 public:
  Observer(const CalibrationOptions& options, std::size_t rows) : options_(options), rows_(rows) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (!options_.progress) return ceres::SOLVER_CONTINUE;
    const double rmse = std::sqrt(2.0 * summary.cost / static_cast<double>(rows_));
    return options_.progress(summary.iteration, rmse) ? ceres::SOLVER_CONTINUE : ceres::SOLVER_ABORT;
  }

 private:
  const CalibrationOptions& options_;
  std::size_t rows_;
};

/// Standard errors sqrt(diag(s^2 (J^T J)^-1)), s^2 the residual variance.
void fill_standard_errors(const ForceCost& cost, const Objective& objective, const std::vector<double>& optimum,
                          std::vector<FreeParameter>& parameters) {
  const auto rows = static_cast<Eigen::Index>(objective.measured().size());
  const auto n = static_cast<Eigen::Index>(parameters.size());
  if (rows <= n) return;
  Eigen::VectorXd residual(rows);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(rows, n);
  const double* at[] = {optimum.data()};
  double* blocks[] = {jacobian.data()};
  if (!cost.Evaluate(at, residual.data(), blocks)) return;
  const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(normal);
  if (!lu.isInvertible()) return;
  const Eigen::MatrixXd covariance = residual.squaredNorm() / static_cast<double>(rows - n) * lu.inverse();
  for (Eigen::Index k = 0; k < n; ++k) {
    FreeParameter& p = parameters[static_cast<std::size_t>(k)];
    const double deviation = std::sqrt(std::max(0.0, covariance(k, k)));
    p.standard_error = by_logarithm(p.key) ? p.value * deviation : deviation;
  }
}

}  // namespace

FreeParameter declared_parameter(const Experiment& experiment, const std::string& key) {
  const KeyMeaning& m = meaning_of(key);
  const Series& first = experiment.series.front();
  return {key, m.unit, m.get(first), m.lower(first), m.upper(first), std::nullopt};
}

void apply_parameter(const std::string& key, double value, std::vector<Series>& series, ReadingModel& reading) {
  const KeyMeaning& m = meaning_of(key);
  for (Series& s : series) m.set(value, s, reading);
}

Calibration calibrate(const Experiment& experiment, const std::vector<std::string>& keys,
                      const CalibrationOptions& options) {
  Calibration result;
  for (const std::string& key : keys) result.parameters.push_back(declared_parameter(experiment, key));
  Objective objective(experiment, result.parameters);
  const int n = objective.count();
  if (objective.measured().size() < static_cast<std::size_t>(n) + 1) {
    throw numerics::InputError({experiment.file.string(), 0, "fit.free", std::to_string(n) + " keys",
                                "must be fewer than the readings, of which there are " +
                                    std::to_string(objective.measured().size())});
  }

  // Start as declared, and as a soft wire that just spans the mounts.
  std::vector<std::vector<double>> starts(2);
  for (const FreeParameter& p : result.parameters) {
    starts[0].push_back(p.value);
    double other = p.value;
    if (p.key == "wire.bending_stiffness_Nm2") other = 0.05 * p.value;
    if (p.key == "wire.axial_stiffness_N") other = 0.3 * p.value;
    if (p.key == "wire.length_mm") other = 1000.0 * experiment.series.front().test.mount.span * 1.002;
    starts[1].push_back(other);
  }
  // A two-level mesh is accurate enough to find the optimum; the result is evaluated with the asked one.
  SolverSettings search = experiment.solver;
  search.elements = std::min(64, search.elements);
  double best = std::numeric_limits<double>::max();
  std::vector<double> optimum;
  Observer observer(options, objective.measured().size());
  for (std::vector<double>& start : starts) {
    ceres::Problem::Options problem_options;
    problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ForceCost cost(objective, search);
    ceres::Problem problem(problem_options);
    for (int k = 0; k < n; ++k) start[static_cast<std::size_t>(k)] = objective.to_unknown(k, start[static_cast<std::size_t>(k)]);
    problem.AddResidualBlock(&cost, nullptr, start.data());
    for (int k = 0; k < n; ++k) {
      const FreeParameter& p = result.parameters[static_cast<std::size_t>(k)];
      problem.SetParameterLowerBound(start.data(), k, objective.to_unknown(k, p.lower));
      problem.SetParameterUpperBound(start.data(), k, objective.to_unknown(k, p.upper));
    }
    ceres::Solver::Options solve;
    solve.linear_solver_type = ceres::DENSE_QR;
    solve.logging_type = ceres::SILENT;
    solve.max_num_iterations = options.max_iterations;
    solve.function_tolerance = 1e-10;
    solve.parameter_tolerance = 1e-9;
    solve.callbacks.push_back(&observer);
    ceres::Solver::Summary summary;
    ceres::Solve(solve, &problem, &summary);
    result.report.iterations += static_cast<int>(summary.iterations.size());
    if (!summary.IsSolutionUsable() || summary.final_cost >= best) continue;
    best = summary.final_cost;
    optimum = start;
    if (summary.termination_type == ceres::USER_FAILURE) {
      result.report.termination = numerics::Termination::interrupted;
      result.report.message = "interrupted";
      break;
    }
  }
  if (optimum.empty()) {
    result.report.termination = numerics::Termination::step_too_small;
    result.report.message = "the wire could not be computed at any start of the fit";
    return result;
  }
  for (int k = 0; k < n; ++k) {
    const auto c = static_cast<std::size_t>(k);
    result.parameters[c].value = objective.to_value(k, optimum[c]);
  }
  const ForceCost cost(objective, search);
  fill_standard_errors(cost, objective, optimum, result.parameters);
  Objective::Result final = objective.evaluate(optimum.data(), experiment.solver);
  result.misfit = misfit(objective.measured(), final.force);
  result.predictions = std::move(final.predictions);
  result.reading = final.reading;
  result.evaluations = objective.evaluations;
  return result;
}

}  // namespace snare::identification
