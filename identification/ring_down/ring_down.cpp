#include "identification/ring_down/ring_down.hpp"

#include "identification/fitting/identifiability.hpp"
#include "identification/fitting/statistics.hpp"
#include "identification/ring_down/oscillations.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>

namespace snare::identification {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

constexpr double least_significant_bic = 10.0;

class Misfit final : public ceres::CostFunction {
 public:
  Misfit(const OscillationLayout& layout, const VectorXd& time, const VectorXd& values, double scale)
      : layout_(layout), time_(time), values_(values), scale_(scale) {
    set_num_residuals(static_cast<int>(time.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(layout.size()));
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const VectorXd p = Eigen::Map<const VectorXd>(parameters[0], layout_.size());
    MatrixXd by;
    const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
    const VectorXd model = oscillations(layout_, p, time_, derivatives ? &by : nullptr);
    Eigen::Map<VectorXd>(residuals, num_residuals()) = (model - values_) / scale_;
    if (derivatives) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          jacobians[0], num_residuals(), layout_.size()) = by / scale_;
    }
    return model.allFinite();
  }

 private:
  const OscillationLayout& layout_;
  const VectorXd& time_;
  const VectorXd& values_;
  double scale_;
};

struct Solution {
  VectorXd numbers;
  numerics::SolveReport report;
};

Solution solve(const OscillationLayout& layout, const VectorXd& start, const VectorXd& time,
               const VectorXd& values) {
  Solution solution{start, {}};
  const double scale = (values.array() - values.mean()).abs().maxCoeff();
  ceres::Problem::Options owning;
  owning.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(owning);
  Misfit misfit(layout, time, values, scale);
  problem.AddResidualBlock(&misfit, nullptr, solution.numbers.data());
  for (Index m = 0; m < layout.modes; ++m) {
    problem.SetParameterLowerBound(solution.numbers.data(), static_cast<int>(layout.decay(m)), 0.0);
  }
  if (layout.rubbing >= 0) {
    problem.SetParameterLowerBound(solution.numbers.data(), static_cast<int>(layout.friction()), 0.0);
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
    solution.report.end(numerics::Termination::not_finite, summary.message);
  }
  return solution;
}

/// Angular frequency of the largest peak of the spectrum of the readings, carried over to even times; padded
/// fourfold.
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

/// C, S, w, s of one oscillation: best over a grid of w about the peak and of s, C, S and the offset by
/// linear least squares.
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
  const Index needed = std::max(least, 3 * (OscillationLayout::numbers_a_mode * data.modes + 2));
  if (data.time.size() < needed)
    return fmt::format("has {} readings, must have at least {}", data.time.size(), needed);
  for (Index i = 1; i < data.time.size(); ++i) {
    if (data.time[i] <= data.time[i - 1]) return fmt::format("time_s must rise, reading {} does not", i + 1);
  }
  if (data.displacement.maxCoeff() == data.displacement.minCoeff()) return "does not move";
  return "";
}

namespace {

/// A fit under way: where its numbers stand, and what they are.
struct Numbers {
  OscillationLayout layout;
  VectorXd p;
  numerics::SolveReport report;

  [[nodiscard]] VectorXd residual(const VectorXd& time, const VectorXd& values) const {
    return values - oscillations(layout, p, time);
  }
  [[nodiscard]] double amplitude(Index m) const { return std::hypot(p[layout.cosine(m)], p[layout.sine(m)]); }
  [[nodiscard]] Index largest() const {
    Index result = 0;
    for (Index m = 1; m < layout.modes; ++m) {
      if (amplitude(m) > amplitude(result)) result = m;
    }
    return result;
  }
};

/// The modes one after the other, each from the spectrum of what those before it leave, then all together.
Numbers fit_modes(int modes, const VectorXd& time, const VectorXd& values) {
  Numbers now{{}, VectorXd::Constant(1, values.mean()), {}};
  for (Index m = 0; m < modes; ++m) {
    const Eigen::Vector4d guess = first_guess(time, now.residual(time, values));
    now.layout.modes = m + 1;
    VectorXd start(now.layout.size());
    start << now.p, guess;
    const Solution solution = solve(now.layout, start, time, values);
    now.p = solution.numbers;
    now.report = solution.report;
  }
  return now;
}

/// Friction of mode `largest` besides, where BIC falls by enough; else as it was. bic_gain: of friction, 0
/// without a fit.
Numbers with_friction(const Numbers& without, Index largest, const VectorXd& time, const VectorXd& values,
                      double& bic_gain) {
  Numbers rubbing = without;
  rubbing.layout.rubbing = largest;
  // A third of the decay at the start is given to friction.
  const Index decay = without.layout.decay(largest);
  VectorXd start(rubbing.layout.size());
  start << without.p, without.p[decay] / 3.0;
  start[decay] *= 2.0 / 3.0;
  const Solution other = solve(rubbing.layout, start, time, values);
  if (!other.report.usable()) return without;
  rubbing.p = other.numbers;
  rubbing.report = other.report;
  bic_gain = bic(without.residual(time, values), without.layout.size()) -
             bic(rubbing.residual(time, values), rubbing.layout.size());
  return bic_gain > least_significant_bic ? rubbing : without;
}

/// s^2 (J^T J)^-1 with the residual's variance s^2; infinite variances of numbers that the readings do not
/// determine, (I.32).
MatrixXd covariance_of(const MatrixXd& by, const VectorXd& residual) {
  const Identifiability rank = identifiability_of(by, {});
  const double variance = residual.squaredNorm() / static_cast<double>(residual.size() - by.cols());
  MatrixXd covariance = variance * rank.covariance;
  for (Index k = 0; k < covariance.rows(); ++k)
    if (!rank.is_known(static_cast<std::size_t>(k)))
      covariance(k, k) = std::numeric_limits<double>::infinity();
  return covariance;
}

/// One mode's numbers; errors of what is computed of several of them by their slopes.
RingDownMode mode_of(const Numbers& now, const MatrixXd& covariance, Index m) {
  const OscillationLayout& layout = now.layout;
  const VectorXd& p = now.p;
  const auto error_along = [&](const Eigen::Vector2d& slope, Index first) {
    if (!covariance.diagonal().segment<2>(first).allFinite()) return std::numeric_limits<double>::infinity();
    return std::sqrt(std::max(0.0, slope.dot(covariance.block<2, 2>(first, first) * slope)));
  };
  RingDownMode mode;
  mode.frequency = of(p, covariance, layout.frequency(m), 0.5 / pi);
  mode.decay = of(p, covariance, layout.decay(m));
  // sqrt(C^2 + S^2)
  const double size = now.amplitude(m);
  const Eigen::Vector2d along =
      Eigen::Vector2d(p[layout.cosine(m)], p[layout.sine(m)]) / std::max(size, 1e-300);
  mode.amplitude = {size, error_along(along, layout.cosine(m))};
  // s / sqrt(w^2 + s^2)
  const double w = p[layout.frequency(m)];
  const double s = p[layout.decay(m)];
  const double cube = std::pow(w * w + s * s, 1.5);
  mode.damping_ratio = {s / std::hypot(w, s),
                        error_along(Eigen::Vector2d(-s * w / cube, w * w / cube), layout.frequency(m))};
  return mode;
}

}  // namespace

RingDownFit fit_ring_down(const RingDown& data) {
  const VectorXd time = data.time.array() - data.time[0];
  const VectorXd& values = data.displacement;
  RingDownFit fit;
  Numbers now = fit_modes(data.modes, time, values);
  const Index largest = now.largest();
  if (data.friction) now = with_friction(now, largest, time, values, fit.friction_bic);

  MatrixXd by;
  fit.fitted = oscillations(now.layout, now.p, time, &by);
  fit.report = now.report;
  const VectorXd residual = values - fit.fitted;
  fit.rmse = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
  fit.nrmse = fit.rmse / (values.maxCoeff() - values.minCoeff());
  fit.runs_p = runs_p({residual});
  fit.ljung_box_p = ljung_box_p({residual}, 10);

  const MatrixXd covariance = covariance_of(by, residual);
  std::vector<Index> order(static_cast<std::size_t>(now.layout.modes));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return now.p[now.layout.frequency(a)] < now.p[now.layout.frequency(b)];
  });
  for (const Index m : order) {
    if (m == largest) fit.largest = fit.modes.size();
    fit.modes.push_back(mode_of(now, covariance, m));
  }
  std::vector<Index> decays;
  for (const Index m : order) decays.push_back(now.layout.decay(m));
  fit.decay_covariance = covariance(decays, decays);
  if (now.layout.rubbing >= 0) {
    const Estimate g = of(now.p, covariance, now.layout.friction());
    const double size = fit.modes[fit.largest].amplitude.value;
    fit.friction = Estimate{g.value * size, g.error * size};
  }
  return fit;
}

}  // namespace snare::identification
