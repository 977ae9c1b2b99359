#include "identification/ring_down/ring_down.hpp"

#include "identification/fitting/statistics.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <Eigen/Dense>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace snare::identification {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

constexpr Index numbers_a_mode = 4;  // C, S, w, s
constexpr double least_significant_bic = 10.0;

/// An envelope and its derivatives by s and g.
struct Envelope {
  double value = 0.0, by_decay = 0.0, by_friction = 0.0;
};

Envelope envelope(double s, double g, double t) {
  const double decayed = std::exp(-s * t);
  // (1 - exp(-s t))/s and its derivative by s, by their series where s t is small.
  const double x = s * t;
  double lost = t;
  double lost_by_s = -0.5 * t * t;
  if (std::abs(x) > 1e-4) {
    lost = -std::expm1(-x) / s;
    lost_by_s = (t * decayed - lost) / s;
  } else {
    lost *= 1.0 - x / 2.0 + x * x / 6.0;
    lost_by_s *= 1.0 - 2.0 * x / 3.0 + x * x / 4.0;
  }
  const double value = decayed - g * lost;
  if (value <= 0.0) return {};
  return {value, -t * decayed - g * lost_by_s, -lost};
}

/// Offset, then four numbers a mode, then g of mode `rubbing` (-1: none).
struct Layout {
  Index modes = 0;
  Index rubbing = -1;
  [[nodiscard]] Index size() const { return 1 + numbers_a_mode * modes + (rubbing >= 0 ? 1 : 0); }
  [[nodiscard]] Index of(Index mode) const { return 1 + numbers_a_mode * mode; }
};

/// Values and, where `by` is given, derivatives; time from the first reading.
VectorXd evaluate(const Layout& layout, const VectorXd& p, const VectorXd& time, MatrixXd* by) {
  VectorXd values = VectorXd::Constant(time.size(), p[0]);
  if (by != nullptr) {
    by->setZero(time.size(), layout.size());
    by->col(0).setOnes();
  }
  for (Index m = 0; m < layout.modes; ++m) {
    const Index k = layout.of(m);
    const double g = m == layout.rubbing ? p[layout.size() - 1] : 0.0;
    for (Index i = 0; i < time.size(); ++i) {
      const double t = time[i];
      const Envelope e = envelope(p[k + 3], g, t);
      const double c = std::cos(p[k + 2] * t);
      const double s = std::sin(p[k + 2] * t);
      const double swing = p[k] * c + p[k + 1] * s;
      values[i] += e.value * swing;
      if (by == nullptr) continue;
      (*by)(i, k) = e.value * c;
      (*by)(i, k + 1) = e.value * s;
      (*by)(i, k + 2) = e.value * t * (p[k + 1] * c - p[k] * s);
      (*by)(i, k + 3) = e.by_decay * swing;
      if (m == layout.rubbing) (*by)(i, layout.size() - 1) = e.by_friction * swing;
    }
  }
  return values;
}

class Misfit final : public ceres::CostFunction {
 public:
  Misfit(const Layout& layout, const VectorXd& time, const VectorXd& values, double scale)
      : layout_(layout), time_(time), values_(values), scale_(scale) {
    set_num_residuals(static_cast<int>(time.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(layout.size()));
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const VectorXd p = Eigen::Map<const VectorXd>(parameters[0], layout_.size());
    MatrixXd by;
    const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
    const VectorXd model = evaluate(layout_, p, time_, derivatives ? &by : nullptr);
    Eigen::Map<VectorXd>(residuals, num_residuals()) = (model - values_) / scale_;
    if (derivatives) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          jacobians[0], num_residuals(), layout_.size()) = by / scale_;
    }
    return model.allFinite();
  }

 private:
  const Layout& layout_;
  const VectorXd& time_;
  const VectorXd& values_;
  double scale_;
};

struct Solution {
  VectorXd numbers;
  numerics::SolveReport report;
};

Solution solve(const Layout& layout, const VectorXd& start, const VectorXd& time, const VectorXd& values) {
  Solution solution{start, {}};
  const double scale = (values.array() - values.mean()).abs().maxCoeff();
  ceres::Problem::Options owning;
  owning.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(owning);
  Misfit misfit(layout, time, values, scale);
  problem.AddResidualBlock(&misfit, nullptr, solution.numbers.data());
  for (Index m = 0; m < layout.modes; ++m) {
    problem.SetParameterLowerBound(solution.numbers.data(), static_cast<int>(layout.of(m) + 3), 0.0);
  }
  if (layout.rubbing >= 0) {
    problem.SetParameterLowerBound(solution.numbers.data(), static_cast<int>(layout.size() - 1), 0.0);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  solution.report.iterations = static_cast<int>(summary.iterations.size());
  solution.report.residual_norm = std::sqrt(2.0 * summary.final_cost) * scale;
  solution.report.termination = summary.termination_type == ceres::CONVERGENCE
                                    ? numerics::Termination::converged
                                    : numerics::Termination::iteration_limit;
  if (!summary.IsSolutionUsable() || !solution.numbers.allFinite()) {
    solution.report.termination = numerics::Termination::not_finite;
    solution.report.message = summary.message;
  }
  return solution;
}

/// Angular frequency of the largest peak of the spectrum of the readings, carried over to even times; padded fourfold.
double peak_frequency(const VectorXd& time, const VectorXd& values) {
  std::size_t count = 16;
  while (count < static_cast<std::size_t>(time.size())) count *= 2;
  const double duration = time[time.size() - 1];
  const double step = duration / static_cast<double>(count - 1);
  std::vector<double> even(4 * count, 0.0);
  Index j = 0;
  const double mean = values.mean();
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) * step;
    while (j + 2 < time.size() && time[j + 1] < t) ++j;
    const double share = std::clamp((t - time[j]) / (time[j + 1] - time[j]), 0.0, 1.0);
    even[i] = values[j] + share * (values[j + 1] - values[j]) - mean;
  }
  Eigen::FFT<double> transform;
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, even);
  // From one period in the record on; below the offset and drifts live.
  std::size_t best = 4;
  for (std::size_t k = 4; k < 2 * count; ++k) {
    if (std::norm(spectrum[k]) > std::norm(spectrum[best])) best = k;
  }
  return 2.0 * pi * static_cast<double>(best) / (4.0 * static_cast<double>(count) * step);
}

/// C, S, w, s of one oscillation: best over a grid of w about the peak and of s, C, S and the offset by linear least squares.
Eigen::Vector4d first_guess(const VectorXd& time, const VectorXd& values) {
  const double duration = time[time.size() - 1];
  const double peak = peak_frequency(time, values);
  Eigen::Vector4d best = Eigen::Vector4d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int i = -3; i <= 3; ++i) {
    const double w = peak + 0.25 * i * 2.0 * pi / duration;
    if (w <= 0.0) continue;
    for (int k = -4; k <= 10; ++k) {
      const double s = std::pow(2.0, k) / duration;
      MatrixXd basis(time.size(), 3);
      basis.col(0).setOnes();
      basis.col(1) = (-s * time.array()).exp() * (w * time.array()).cos();
      basis.col(2) = (-s * time.array()).exp() * (w * time.array()).sin();
      const Eigen::Vector3d share = (basis.transpose() * basis).ldlt().solve(basis.transpose() * values);
      const double left = (values - basis * share).squaredNorm();
      if (!(left < least)) continue;
      least = left;
      best << share[1], share[2], w, s;
    }
  }
  return best;
}

Estimate of(const VectorXd& p, const MatrixXd& covariance, Index k, double unit = 1.0) {
  return {unit * p[k], unit * std::sqrt(std::max(0.0, covariance(k, k)))};
}

double bic(const VectorXd& residual, Index numbers) {
  const double n = static_cast<double>(residual.size());
  return n * std::log(std::max(residual.squaredNorm() / n, 1e-300)) +
         static_cast<double>(numbers) * std::log(n);
}

}  // namespace

double RingDownMode::natural() const {
  return std::hypot(2.0 * pi * frequency.value, decay.value);
}

std::string ring_down_problem(const RingDown& data) {
  constexpr Index least = 20;
  const Index needed = std::max(least, 3 * (numbers_a_mode * data.modes + 2));
  if (data.time.size() < needed)
    return fmt::format("has {} readings, must have at least {}", data.time.size(), needed);
  for (Index i = 1; i < data.time.size(); ++i) {
    if (data.time[i] <= data.time[i - 1]) return fmt::format("time_s must rise, reading {} does not", i + 1);
  }
  if (data.displacement.maxCoeff() == data.displacement.minCoeff()) return "does not move";
  return "";
}

RingDownFit fit_ring_down(const RingDown& data) {
  const VectorXd time = data.time.array() - data.time[0];
  const VectorXd& values = data.displacement;
  Layout layout;
  VectorXd p = VectorXd::Constant(1, values.mean());
  Solution solution;
  for (Index m = 0; m < data.modes; ++m) {
    const VectorXd left = values - evaluate(layout, p, time, nullptr);
    const Eigen::Vector4d guess = first_guess(time, left);
    layout.modes = m + 1;
    VectorXd start(layout.size());
    start << p, guess;
    solution = solve(layout, start, time, values);
    p = solution.numbers;
  }
  RingDownFit fit;
  const auto amplitude = [&](Index m) { return std::hypot(p[layout.of(m)], p[layout.of(m) + 1]); };
  Index largest = 0;
  for (Index m = 1; m < layout.modes; ++m) {
    if (amplitude(m) > amplitude(largest)) largest = m;
  }
  if (data.friction) {
    const double without = bic(values - evaluate(layout, p, time, nullptr), layout.size());
    Layout rubbing = layout;
    rubbing.rubbing = largest;
    // A third of the decay at the start is given to friction.
    const Index decay = layout.of(largest) + 3;
    VectorXd start(rubbing.size());
    start << p, p[decay] / 3.0;
    start[decay] *= 2.0 / 3.0;
    const Solution other = solve(rubbing, start, time, values);
    if (other.report.usable()) {
      fit.friction_bic =
          without - bic(values - evaluate(rubbing, other.numbers, time, nullptr), rubbing.size());
      if (fit.friction_bic > least_significant_bic) {
        layout = rubbing;
        p = other.numbers;
        solution = other;
      }
    }
  }
  MatrixXd by;
  fit.fitted = evaluate(layout, p, time, &by);
  fit.report = solution.report;
  const VectorXd residual = values - fit.fitted;
  fit.rmse = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
  fit.nrmse = fit.rmse / (values.maxCoeff() - values.minCoeff());
  fit.runs_p = runs_p({residual});
  fit.ljung_box_p = ljung_box_p({residual}, 10);
  // Columns scaled to one: units differ by powers of ten.
  const VectorXd scale = by.colwise().norm().cwiseMax(1e-300);
  const MatrixXd scaled = by * scale.cwiseInverse().asDiagonal();
  const double variance = residual.squaredNorm() / static_cast<double>(residual.size() - layout.size());
  const MatrixXd covariance =
      variance * scale.cwiseInverse().asDiagonal() *
      (scaled.transpose() * scaled).completeOrthogonalDecomposition().pseudoInverse() *
      scale.cwiseInverse().asDiagonal();
  std::vector<Index> order;
  for (Index m = 0; m < layout.modes; ++m) order.push_back(m);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return p[layout.of(a) + 2] < p[layout.of(b) + 2]; });
  for (const Index m : order) {
    const Index k = layout.of(m);
    RingDownMode mode;
    mode.frequency = of(p, covariance, k + 2, 0.5 / pi);
    mode.decay = of(p, covariance, k + 3);
    const double size = amplitude(m);
    const Eigen::Vector2d along = Eigen::Vector2d(p[k], p[k + 1]) / std::max(size, 1e-300);
    mode.amplitude = {size, std::sqrt(std::max(0.0, along.dot(covariance.block<2, 2>(k, k) * along)))};
    const double w = p[k + 2];
    const double s = p[k + 3];
    const double cube = std::pow(w * w + s * s, 1.5);
    const Eigen::Vector2d slope(-s * w / cube, w * w / cube);
    mode.damping_ratio = {s / std::hypot(w, s),
                          std::sqrt(std::max(0.0, slope.dot(covariance.block<2, 2>(k + 2, k + 2) * slope)))};
    if (m == largest) fit.largest = fit.modes.size();
    fit.modes.push_back(mode);
  }
  if (layout.rubbing >= 0) {
    const Estimate g = of(p, covariance, layout.size() - 1);
    const double size = fit.modes[fit.largest].amplitude.value;
    fit.friction = Estimate{g.value * size, g.error * size};
  }
  return fit;
}

DampingSplit split_damping(const std::vector<DecayOfMode>& decays) {
  DampingSplit split;
  if (decays.empty()) {
    split.statement = "no mode stands out of the noise: nothing is known";
    return split;
  }
  const auto n = static_cast<Index>(decays.size());
  MatrixXd rows(n, 2);  // by bending_time, by mass_rate, both over the standard error
  VectorXd right(n);
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  double best = std::numeric_limits<double>::infinity();
  std::size_t surest = 0;
  for (Index i = 0; i < n; ++i) {
    const DecayOfMode& d = decays[static_cast<std::size_t>(i)];
    const double square = d.bending_share * d.natural * d.natural;
    // Noise that vanishes, or a rate on its bound, must not weigh endlessly.
    const double error = 2.0 * std::max(d.decay.error, 1e-9 * d.natural);
    rows.row(i) << square / error, 1.0 / error;
    right[i] = 2.0 * d.decay.value / error;
    low = std::min(low, square);
    high = std::max(high, square);
    if (error / square < best) {
      best = error / square;
      surest = static_cast<std::size_t>(i);
    }
  }
  constexpr double far_enough = 1.5;
  if (high < far_enough * low) {
    const VectorXd material = rows.col(0);
    const VectorXd mass = rows.col(1);
    split.bending_time = {material.dot(right) / material.squaredNorm(), 1.0 / material.norm()};
    split.mass_rate = {mass.dot(right) / mass.squaredNorm(), 1.0 / mass.norm()};
    split.correlation = -1.0;
    split.statement = fmt::format(
        "all decays are at nearly one frequency ({:.4g} Hz): known is mass_rate + bending_time w^2 = {:.4g} "
        "1/s, its split is "
        "not; all material would be bending_time_s = {:.4g}, all mass-proportional mass_rate_1_s = {:.4g}. A "
        "second mode, or "
        "the same wire at another span, separates them",
        decays[surest].natural / (2.0 * pi), split.mass_rate.value, split.bending_time.value,
        split.mass_rate.value);
    return split;
  }
  split.separated = true;
  const Eigen::Matrix2d covariance = (rows.transpose() * rows).inverse();
  Eigen::Vector2d x = covariance * (rows.transpose() * right);
  const Eigen::Vector2d error = covariance.diagonal().cwiseSqrt();
  split.correlation = covariance(0, 1) / (error[0] * error[1]);
  const double chi2 = (right - rows * x).squaredNorm();
  if (n > 2) split.misfit_p = chi_square_tail(chi2, static_cast<double>(n - 2));
  split.bending_time = {x[0], error[0]};
  split.mass_rate = {x[1], error[1]};
  split.statement = "bending_time and mass_rate are separated";
  for (Index k = 0; k < 2; ++k) {
    const Estimate& e = k == 0 ? split.bending_time : split.mass_rate;
    const char* name = k == 0 ? "bending_time" : "mass_rate";
    if (e.upper() < 0.0) {
      split.statement +=
          fmt::format("; {} would be negative: the decays do not follow mass_rate + bending_time w^2", name);
    } else if (e.lower() < 0.0) {
      split.statement += fmt::format("; {} is not different from zero, at most {:.4g}", name, e.upper());
    }
  }
  constexpr double unlikely = 0.01;
  if (split.misfit_p < unlikely) {
    split.statement += fmt::format(
        "; the {} decays do not lie on one line (P = {:.2g}): another damping is at work, or a "
        "bending_share is wrong",
        n, split.misfit_p);
  }
  return split;
}

}  // namespace snare::identification
