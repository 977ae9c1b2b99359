#include "identification/fitting/least_squares.hpp"

#include "numerics/dense_solvers.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

/// One whitened residual vector as a function of scaled coordinates. The last evaluation is kept, since Ceres
/// asks for the derivatives where it has just asked for the values, and the best one, which is where it ends.
class Residuals final : public ceres::CostFunction {
 public:
  Residuals(const Model& model, const Data& data, std::vector<Setting> settings, std::size_t free,
            Eigen::VectorXd scale)
      : model_(model), data_(data), settings_(std::move(settings)), free_(free), scale_(std::move(scale)) {
    set_num_residuals(static_cast<int>(data.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(free));
    for (std::size_t k = 0; k < free; ++k) by_.push_back(settings_[k].parameter);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> at(parameters[0], static_cast<Eigen::Index>(free_));
    const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
    if (best_.is_at(at) && !last_.is_at(at)) last_ = best_;
    if (!last_.is_at(at) || (derivatives && last_.evaluation.by.empty())) {
      std::vector<Setting> settings = settings_;
      for (std::size_t k = 0; k < free_; ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        settings[k].coordinate = at[i] * scale_[i];
      }
      keep(at, model_.evaluate(settings, derivatives || cheap_ ? by_ : std::vector<const Parameter*>{}));
    }
    if (!last_.evaluation.complete) {
      last_.at.resize(0);
      return false;
    }
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = -data_.residual(last_.evaluation);
    if (derivatives) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          jacobians[0], num_residuals(), static_cast<Eigen::Index>(free_)) =
          data_.jacobian(last_.evaluation) * scale_.asDiagonal();
    }
    return true;
  }
  void derivatives_are_dear() { cheap_ = false; }

  /// An evaluation made elsewhere.
  void keep(const Eigen::VectorXd& at, Evaluation evaluation) const {
    last_ = {at, std::move(evaluation), std::numeric_limits<double>::max()};
    if (!last_.evaluation.complete) return;
    last_.chi2 = data_.residual(last_.evaluation).squaredNorm();
    if (last_.chi2 < best_.chi2 || best_.is_at(at)) best_ = last_;
  }
  /// The evaluation there with its derivatives, if it is known; else null.
  [[nodiscard]] const Evaluation* known(const Eigen::VectorXd& at) const {
    return best_.is_at(at) && !best_.evaluation.by.empty() ? &best_.evaluation : nullptr;
  }

 private:
  struct Kept {
    Eigen::VectorXd at;
    Evaluation evaluation;
    double chi2 = std::numeric_limits<double>::max();
    [[nodiscard]] bool is_at(const Eigen::VectorXd& other) const {
      return at.size() == other.size() && at == other;
    }
  };

  const Model& model_;
  const Data& data_;
  std::vector<Setting> settings_;
  std::size_t free_;
  Eigen::VectorXd scale_;
  std::vector<const Parameter*> by_;
  bool cheap_ = true;
  mutable Kept last_;
  mutable Kept best_;
};

class Observer final : public ceres::IterationCallback {
 public:
  explicit Observer(const FitOptions& options) : options_(options) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    if (options_.progress && !options_.progress(s.iteration, 2.0 * s.cost)) return ceres::SOLVER_ABORT;
    // A refused step reports its own cost: the fit stands where it stood.
    chi2_.push_back(chi2_.empty() ? 2.0 * s.cost : std::min(2.0 * s.cost, chi2_.back()));
    const std::size_t n = chi2_.size();
    if (!(options_.rival > 0.0) || n <= pace) return ceres::SOLVER_CONTINUE;
    const double fall = (chi2_[n - 1 - pace] - chi2_[n - 1]) / pace;
    const double left = std::min(patience, options_.max_iterations - s.iteration);
    return chi2_.back() - left * fall > options_.rival ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                       : ceres::SOLVER_CONTINUE;
  }

 private:
  static constexpr std::size_t pace = 3;  // iterations over which the pace is taken: some steps are refused
  static constexpr int patience = 10;     // iterations for which a pace can last: it slackens
  const FitOptions& options_;
  std::vector<double> chi2_;
};

}  // namespace

double Fit::bic() const {
  return chi2 + static_cast<double>(free) *
                    std::log(static_cast<double>(std::max<Eigen::Index>(residual.size(), 1)));
}

std::vector<Setting> Fit::fitted() const {
  return {settings.begin(), settings.begin() + static_cast<std::ptrdiff_t>(free)};
}

std::vector<Setting> Fit::fixed() const {
  return {settings.begin() + static_cast<std::ptrdiff_t>(free), settings.end()};
}

std::vector<const Parameter*> Fit::parameters() const {
  std::vector<const Parameter*> result;
  for (std::size_t k = 0; k < free; ++k) result.push_back(settings[k].parameter);
  return result;
}

Eigen::MatrixXd unit_directions(const Eigen::MatrixXd& jacobian) {
  const Eigen::Index n = jacobian.cols();
  if (n == 0) return {};
  Eigen::VectorXd scale(n);
  for (Eigen::Index k = 0; k < n; ++k) scale[k] = 1.0 / std::max(jacobian.col(k).norm(), 1e-300);
  const numerics::ThinSvd svd = numerics::thin_svd(jacobian * scale.asDiagonal());
  Eigen::Index rank = 0;
  while (rank < svd.s.size() && svd.s[rank] > 1e-10 * svd.s[0]) ++rank;
  return scale.asDiagonal() * svd.V.leftCols(rank) * svd.s.head(rank).cwiseInverse().asDiagonal();
}

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& jacobian) {
  const Eigen::MatrixXd directions = unit_directions(jacobian);
  return directions * directions.transpose();
}

namespace {

/// What follows from an evaluation with its derivatives.                                 theory.md (I.1)
///   r = L^-1 (measured - computed),  J = L^-1 dF/dc,  chi2 = r^T r,  covariance (J^T J)^-1
void take(const Data& data, Evaluation evaluation, Fit& fit) {
  fit.evaluation = std::move(evaluation);
  fit.residual = data.residual(fit.evaluation);
  fit.jacobian = data.jacobian(fit.evaluation);
  fit.chi2 = fit.residual.squaredNorm();
  fit.covariance = covariance_of(fit.jacobian);
  fit.estimated = data.noise.estimated;
  fit.noise_dof = data.noise.dof;
}

void fail(const std::string& message, Fit& fit) {
  fit.report.end(numerics::Termination::step_too_small, message);
}

/// The unknown is the coordinate over a scale by which it changes the residual by about one standard
/// deviation in all.
Eigen::VectorXd scale_of(const Eigen::MatrixXd& jacobian) {
  Eigen::VectorXd scale(jacobian.cols());
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    const double norm = jacobian.col(k).norm();
    scale[k] = norm > 0.0 ? 1.0 / norm : 1.0;
  }
  return scale;
}

/// Gives the bounds of the numbers to the problem and moves the unknowns inside. Whether one of them had to
/// move.
bool bound(const Model& model, const Fit& fit, const Eigen::VectorXd& scale, Eigen::VectorXd& unknown,
           ceres::Problem& problem) {
  bool moved = false;
  for (int k = 0; k < static_cast<int>(unknown.size()); ++k) {
    const Parameter& p = *fit.settings[static_cast<std::size_t>(k)].parameter;
    const double lower = model.lower(p) / scale[k];
    const double upper = model.upper(p) / scale[k];
    moved = moved || unknown[k] < lower || unknown[k] > upper;
    unknown[k] = std::clamp(unknown[k], lower, upper);
    problem.SetParameterLowerBound(unknown.data(), k, lower);
    problem.SetParameterUpperBound(unknown.data(), k, upper);
  }
  return moved;
}

ceres::Solver::Summary solve(const FitOptions& options, ceres::Problem& problem) {
  ceres::Solver::Options solve;
  solve.linear_solver_type = ceres::DENSE_QR;
  solve.logging_type = ceres::SILENT;
  solve.max_num_iterations = options.max_iterations;
  solve.function_tolerance = options.tolerance;
  solve.parameter_tolerance = 0.01 * options.tolerance;
  solve.gradient_tolerance = 1e-12;
  solve.max_num_consecutive_invalid_steps = 12;
  Observer observer(options);
  solve.callbacks.push_back(&observer);
  ceres::Solver::Summary summary;
  ceres::Solve(solve, &problem, &summary);
  return summary;
}

/// Numbers on a bound that a descent of chi2 would take beyond it, by their index.
std::vector<int> kept_by_bounds(const ceres::Problem& problem, const Eigen::VectorXd& unknown,
                                const Eigen::VectorXd& gradient) {
  std::vector<int> result;
  for (int k = 0; k < static_cast<int>(unknown.size()); ++k) {
    const bool below = unknown[k] <= problem.GetParameterLowerBound(unknown.data(), k) && gradient[k] > 0.0;
    const bool above = unknown[k] >= problem.GetParameterUpperBound(unknown.data(), k) && gradient[k] < 0.0;
    if (below || above) result.push_back(k);
  }
  return result;
}

/// What chi2 can fall by, to first order, where the numbers `kept` stay: g^T (J^T J)^-1 g of the others.
double fall_of_others(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& gradient,
                      const std::vector<int>& kept) {
  std::vector<Eigen::Index> others;
  for (Eigen::Index k = 0; k < gradient.size(); ++k) {
    if (std::find(kept.begin(), kept.end(), k) == kept.end()) others.push_back(k);
  }
  if (others.empty()) return 0.0;
  return (unit_directions(jacobian(Eigen::all, others)).transpose() * gradient(others)).squaredNorm();
}

/// Steps that are cut off at a bound may end where chi2 still falls along it. Such a fit is continued with
/// the numbers held that are kept by their bounds, until the others come to rest and no held number would
/// leave its bound. Returns the iterations.
int solve_along_bounds(const FitOptions& options, const Residuals& residuals, Eigen::VectorXd& unknown,
                       ceres::Problem& problem, ceres::Solver::Summary& summary) {
  constexpr int most = 4;
  int iterations = 0;
  const auto n = static_cast<int>(unknown.size());
  Eigen::VectorXd r(residuals.num_residuals());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(r.size(), n);
  for (int k = 0; k < most && summary.termination_type == ceres::CONVERGENCE; ++k) {
    const double* at = unknown.data();
    double* derivatives = jacobian.data();
    if (!residuals.Evaluate(&at, r.data(), &derivatives)) return iterations;
    const Eigen::VectorXd gradient = jacobian.transpose() * r;
    const std::vector<int> kept = kept_by_bounds(problem, unknown, gradient);
    const bool held = problem.HasManifold(unknown.data());
    if (kept.empty() && !held) return iterations;
    if (fall_of_others(jacobian, gradient, kept) <= options.tolerance * r.squaredNorm()) return iterations;
    problem.SetManifold(unknown.data(), new ceres::SubsetManifold(n, kept));
    summary = solve(options, problem);
    iterations += static_cast<int>(summary.iterations.size());
  }
  return iterations;
}

}  // namespace

Fit fit(const Model& model, const Data& data, const std::vector<Setting>& start,
        const std::vector<Setting>& fixed, const FitOptions& options) {
  Fit result;
  result.settings = start;
  result.free = start.size();
  result.settings.insert(result.settings.end(), fixed.begin(), fixed.end());
  Evaluation first = model.evaluate(result.settings, result.parameters());
  if (!first.complete) {
    fail(first.message, result);
    result.evaluation = std::move(first);
    return result;
  }
  take(data, std::move(first), result);
  if (start.empty()) return result;

  const Eigen::VectorXd scale = scale_of(result.jacobian);
  Eigen::VectorXd unknown(scale.size());
  for (Eigen::Index k = 0; k < unknown.size(); ++k) {
    unknown[k] = start[static_cast<std::size_t>(k)].coordinate / scale[k];
  }
  Residuals residuals(model, data, result.settings, result.free, scale);
  for (const Series& s : model.apply(result.settings).series) {
    if (!coupling::differentiable(s.test)) residuals.derivatives_are_dear();
  }
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  problem.AddResidualBlock(&residuals, nullptr, unknown.data());
  if (!bound(model, result, scale, unknown, problem)) residuals.keep(unknown, result.evaluation);
  ceres::Solver::Summary summary = solve(options, problem);
  result.report.iterations = static_cast<int>(summary.iterations.size());
  result.report.iterations += solve_along_bounds(options, residuals, unknown, problem, summary);
  if (summary.termination_type == ceres::USER_FAILURE) {
    result.report.end(numerics::Termination::interrupted, "interrupted");
  } else if (!summary.IsSolutionUsable()) {
    fail("the least squares did not converge", result);
    return result;
  }
  for (std::size_t k = 0; k < result.free; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    result.settings[k].coordinate = unknown[i] * scale[i];
  }
  const Evaluation* known = residuals.known(unknown);
  Evaluation at = known != nullptr ? *known : model.evaluate(result.settings, result.parameters());
  if (at.complete) {
    take(data, std::move(at), result);
  } else {
    fail(at.message, result);
  }
  return result;
}

namespace {

/// Whether chi2 stays where it is when the number that moves most along `direction` is moved and held.
bool stays_along(const Model& model, const Data& data, const Fit& optimum, const Eigen::VectorXd& direction) {
  Eigen::Index most = 0;
  optimum.jacobian.colwise().norm().transpose().cwiseProduct(direction).cwiseAbs().maxCoeff(&most);
  const Setting& centre = optimum.settings[static_cast<std::size_t>(most)];
  const double lower = model.lower(*centre.parameter), upper = model.upper(*centre.parameter);
  const double promised =
      (optimum.jacobian * direction).norm() / std::abs(direction[most]);  // by a step of one
  // At most a fifth of the number itself, a tenth of where it may be: far beyond its standard error, were it
  // known.
  const double far =
      centre.parameter->parametrisation == Parametrisation::shift ? 0.1 * (upper - lower) : 0.2;
  double step = std::min(far, doubtful_change / std::max(promised, 1e-300));
  if (centre.coordinate + step > upper) step = -step;
  if (centre.coordinate + step < lower) return false;
  FitOptions options;
  options.max_iterations = 15;
  std::vector<Setting> others, held{{centre.parameter, centre.coordinate + step}};
  for (std::size_t k = 0; k < optimum.free; ++k) {
    if (k == static_cast<std::size_t>(most)) continue;
    Setting& s = others.emplace_back(optimum.settings[k]);
    const double along = step * direction[static_cast<Eigen::Index>(k)] / direction[most];
    s.coordinate = std::clamp(s.coordinate + along, model.lower(*s.parameter), model.upper(*s.parameter));
  }
  const std::vector<Setting> fixed = optimum.fixed();
  held.insert(held.end(), fixed.begin(), fixed.end());
  const Fit moved = fit(model, data, others, held, options);
  return moved.report.usable() && is_no_rise(moved.chi2 - optimum.chi2, promised * step);
}

}  // namespace

void find_rank(const Model& model, const Data& data, Fit& fit) {
  if (fit.free == 0 || !fit.report.usable()) return;
  constexpr double twice = 2.0;
  const Evaluation wide = model.evaluate(fit.settings, fit.parameters(), twice);
  const Eigen::MatrixXd error =
      wide.complete ? Eigen::MatrixXd(data.jacobian(wide) - fit.jacobian) : Eigen::MatrixXd();
  fit.rank = identifiability_of(fit.jacobian, error, [&](const Eigen::VectorXd& direction) {
    return stays_along(model, data, fit, direction);
  });
  if (!fit.rank.directions.empty()) fit.covariance = fit.rank.covariance;
}

namespace {

/// The fitted numbers but `which`, moved along with its step, to first order: c_i += step cov_ij / cov_jj.
std::vector<Setting> others_beside(const Model& model, const Fit& optimum, std::size_t which, double step) {
  const auto j = static_cast<Eigen::Index>(which);
  const double spread = std::sqrt(std::max(optimum.covariance(j, j), 0.0));
  std::vector<Setting> others;
  for (std::size_t k = 0; k < optimum.free; ++k) {
    if (k == which) continue;
    Setting& s = others.emplace_back(optimum.settings[k]);
    const double slope = optimum.covariance(static_cast<Eigen::Index>(k), j) / (spread * spread);
    s.coordinate =
        std::clamp(s.coordinate + step * slope, model.lower(*s.parameter), model.upper(*s.parameter));
  }
  return others;
}

/// chi2 with `held` settings at the optimum of the others, beginning at `others`, by steps with the
/// derivatives of the optimum of all, which need no new ones: where these come to their end, that is expect
/// no more of another than `enough`.
std::optional<double> chi2_by_chords(const Model& model, const Data& data, const Eigen::MatrixXd& jacobian,
                                     std::vector<Setting> others, const std::vector<Setting>& held,
                                     double enough,
                                     const std::function<bool(int iteration, double chi2)>& progress) {
  constexpr int most = 4;
  const Eigen::MatrixXd covariance = covariance_of(jacobian);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most; ++k) {
    std::vector<Setting> all = others;
    all.insert(all.end(), held.begin(), held.end());
    const Evaluation at = model.evaluate(all);
    if (!at.complete) return std::nullopt;
    const Eigen::VectorXd residual = data.residual(at);
    const double chi2 = residual.squaredNorm();
    if (progress && !progress(k, chi2)) return std::nullopt;
    const Eigen::VectorXd gradient = jacobian.transpose() * residual;
    const Eigen::VectorXd step = covariance * gradient;
    if (gradient.dot(step) < enough) return chi2;
    if (!(chi2 < least)) return std::nullopt;
    least = chi2;
    for (std::size_t i = 0; i < others.size(); ++i) {
      Setting& s = others[i];
      s.coordinate = std::clamp(s.coordinate + step[static_cast<Eigen::Index>(i)], model.lower(*s.parameter),
                                model.upper(*s.parameter));
    }
  }
  return std::nullopt;
}

/// One end of a profile's interval, in the direction `sense` (-1 or 1).
std::optional<double> profile_end(const Model& model, const Data& data, const Fit& optimum, std::size_t which,
                                  double rise, double sense,
                                  const std::function<bool(int iteration, double chi2)>& progress) {
  const Setting& centre = optimum.settings[which];
  const auto j = static_cast<Eigen::Index>(which);
  const double spread = std::sqrt(std::max(optimum.covariance(j, j), 0.0));
  const double limit = sense < 0.0 ? model.lower(*centre.parameter) : model.upper(*centre.parameter);
  const std::vector<Setting> fixed = optimum.fixed();
  FitOptions options;
  options.max_iterations = 15;
  const double enough = 0.02 * rise;  // of the chi2 that is looked for
  options.tolerance = std::clamp(enough / std::max(optimum.chi2, 1.0), 1e-6, 1e-3);
  options.progress = progress;
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = 0; k < optimum.jacobian.cols(); ++k) {
    if (k != j) columns.push_back(k);
  }
  const Eigen::MatrixXd jacobian = optimum.jacobian(Eigen::all, columns);
  double step = std::sqrt(rise) * spread;  // where the profile is a parabola
  std::optional<double> end;
  for (int k = 0; k < 4; ++k) {
    const double at = centre.coordinate + sense * step;
    if ((at - limit) * sense >= 0.0) return std::nullopt;
    std::vector<Setting> held{{centre.parameter, at}};
    held.insert(held.end(), fixed.begin(), fixed.end());
    const std::vector<Setting> others = others_beside(model, optimum, which, sense * step);
    std::optional<double> chi2 = chi2_by_chords(model, data, jacobian, others, held, enough, progress);
    if (!chi2) {
      if (progress && !progress(0, optimum.chi2)) return std::nullopt;
      const Fit other = fit(model, data, others, held, options);
      if (other.report.termination == numerics::Termination::interrupted) return std::nullopt;
      if (!other.report.usable()) {
        step *= 0.5;
        continue;
      }
      chi2 = other.chi2;
    }
    const double risen = std::max(*chi2 - optimum.chi2, 1e-3 * rise);
    end = at;
    if (std::abs(risen / rise - 1.0) < 0.05) break;
    step *= std::clamp(std::sqrt(rise / risen), 0.3, 3.0);
    end = centre.coordinate + sense * step;
  }
  return end;
}

}  // namespace

ProfileInterval profile_interval(const Model& model, const Data& data, const Fit& optimum, std::size_t which,
                                 double rise,
                                 const std::function<bool(int iteration, double chi2)>& progress) {
  const auto j = static_cast<Eigen::Index>(which);
  if (!(optimum.covariance(j, j) > 0.0)) return {};
  return {profile_end(model, data, optimum, which, rise, -1.0, progress),
          profile_end(model, data, optimum, which, rise, 1.0, progress)};
}

}  // namespace snare::identification
