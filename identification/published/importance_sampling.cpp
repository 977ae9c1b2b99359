#include "identification/published/importance_sampling.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace snare::identification {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double freedom = 4.0;  // of Student's t

/// Even points of the cube: the additive recurrence by the root of x^(n+1) = x + 1 (Roberts 2018).
std::vector<VectorXd> even_points(Index dimensions, int count) {
  double root = 2.0;
  for (int i = 0; i < 60; ++i) root = std::pow(1.0 + root, 1.0 / static_cast<double>(dimensions + 1));
  std::vector<VectorXd> points;
  for (int i = 0; i < count; ++i) {
    VectorXd u(dimensions);
    for (Index j = 0; j < dimensions; ++j) {
      const double x = 0.5 + (i + 1) * std::pow(1.0 / root, static_cast<double>(j + 1));
      u[j] = x - std::floor(x);
    }
    points.push_back(std::move(u));
  }
  return points;
}

}  // namespace

double log_sum(const std::vector<double>& values) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const double v : values) largest = std::max(largest, v);
  if (!std::isfinite(largest)) return largest;
  double sum = 0.0;
  for (const double v : values) sum += std::exp(v - largest);
  return largest + std::log(sum);
}

ImportanceSampler::ImportanceSampler(Index dimensions, int first, LogIntegrand log_integrand)
    : dimensions_(dimensions),
      log_first_(dimensions > 0 ? std::log(first) : 0.0),
      log_integrand_(std::move(log_integrand)),
      points_{dimensions > 0 ? even_points(dimensions, first) : std::vector<VectorXd>{VectorXd(0)}, {}} {
  values_ = log_integrand_(points_.points);
  weigh();
}

double ImportanceSampler::Student::log_density(const VectorXd& u) const {
  const auto n = static_cast<double>(u.size());
  const double square = root.triangularView<Eigen::Lower>().solve(u - mean).squaredNorm();
  return std::lgamma(0.5 * (freedom + n)) - std::lgamma(0.5 * freedom) -
         0.5 * n * std::log(freedom * std::numbers::pi) - root.diagonal().array().log().sum() -
         0.5 * (freedom + n) * std::log1p(square / freedom);
}

// Mean and scale of the weighted points. A power of the weights below one keeps several of them alive at
// first.
ImportanceSampler::Student ImportanceSampler::proposal() const {
  std::vector<double> log(values_.size());
  for (std::size_t s = 0; s < log.size(); ++s) log[s] = points_.log_weight[s] + values_[s];
  const double largest = *std::ranges::max_element(log);
  const double least_alive = 3.0 + 3.0 * static_cast<double>(dimensions_);
  std::vector<double> w(log.size());
  double power = 1.0;
  for (int i = 0; i < 40; ++i, power *= 0.8) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t s = 0; s < log.size(); ++s) {
      w[s] = std::exp(power * (log[s] - largest));
      sum += w[s];
      squares += w[s] * w[s];
    }
    for (double& one : w) one /= sum;
    if (sum * sum / squares >= least_alive) break;
  }
  Student t{VectorXd::Zero(dimensions_), MatrixXd::Zero(dimensions_, dimensions_)};
  for (std::size_t s = 0; s < w.size(); ++s) t.mean += w[s] * points_.points[s];
  for (std::size_t s = 0; s < w.size(); ++s)
    t.root += w[s] * (points_.points[s] - t.mean) * (points_.points[s] - t.mean).transpose();
  t.root.diagonal().array() += 1e-10;
  t.root = MatrixXd(t.root.llt().matrixL());
  return t;
}

double ImportanceSampler::uniform() {
  return (static_cast<double>(random_() >> 11u) + 0.5) * 0x1p-53;
}

double ImportanceSampler::normal() {
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

void ImportanceSampler::weigh() {
  points_.log_weight.clear();
  for (const VectorXd& u : points_.points) {
    std::vector<double> densities{log_first_};
    for (const Student& p : proposals_) densities.push_back(p.log_size + p.log_density(u));
    points_.log_weight.push_back(-log_sum(densities));
  }
}

void ImportanceSampler::add_batch(int size) {
  if (dimensions_ == 0 || !std::ranges::any_of(values_, [](double v) { return std::isfinite(v); })) return;
  Student t = proposal();
  t.log_size = std::log(size);
  std::vector<VectorXd> inside;
  for (int i = 0; i < size; ++i) {
    double chi = 0.0;
    for (int j = 0; j < static_cast<int>(freedom); ++j) chi += std::pow(normal(), 2);
    VectorXd z(dimensions_);
    for (Index j = 0; j < dimensions_; ++j) z[j] = normal();
    VectorXd u = t.mean + t.root * z * std::sqrt(freedom / chi);
    if (u.minCoeff() >= 0.0 && u.maxCoeff() <= 1.0) inside.push_back(std::move(u));
  }
  proposals_.push_back(std::move(t));
  const std::vector<double> more = log_integrand_(inside);
  points_.points.insert(points_.points.end(), inside.begin(), inside.end());
  values_.insert(values_.end(), more.begin(), more.end());
  weigh();
}

double ImportanceSampler::log_integral() const {
  std::vector<double> terms(values_.size());
  for (std::size_t s = 0; s < terms.size(); ++s) terms[s] = points_.log_weight[s] + values_[s];
  return log_sum(terms);
}

double ImportanceSampler::effective() const {
  if (dimensions_ == 0) return std::numeric_limits<double>::infinity();
  std::vector<double> twice(values_.size());
  for (std::size_t s = 0; s < twice.size(); ++s) twice[s] = 2.0 * (points_.log_weight[s] + values_[s]);
  const double sum = log_integral();
  return std::isfinite(sum) ? std::exp(2.0 * sum - log_sum(twice)) : 0.0;
}

}  // namespace snare::identification
