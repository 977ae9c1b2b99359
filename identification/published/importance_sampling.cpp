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

struct Student {
  VectorXd mean;
  MatrixXd root;  // lower triangle of the scale

  [[nodiscard]] double log_density(const VectorXd& u) const {
    const auto n = static_cast<double>(u.size());
    const double square = root.triangularView<Eigen::Lower>().solve(u - mean).squaredNorm();
    return std::lgamma(0.5 * (freedom + n)) - std::lgamma(0.5 * freedom) -
           0.5 * n * std::log(freedom * std::numbers::pi) - root.diagonal().array().log().sum() -
           0.5 * (freedom + n) * std::log1p(square / freedom);
  }
};

/// Mean and scale of the weighted points. A power of the weights below one keeps several of them alive at first.
Student student_of(const WeightedPoints& all, const std::vector<double>& log_integrand) {
  const Index n = all.points.front().size();
  std::vector<double> log(log_integrand.size());
  for (std::size_t s = 0; s < log.size(); ++s) log[s] = all.log_weight[s] + log_integrand[s];
  const double largest = *std::ranges::max_element(log);
  const double least_alive = 3.0 + 3.0 * static_cast<double>(n);
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
  Student t{VectorXd::Zero(n), MatrixXd::Zero(n, n)};
  for (std::size_t s = 0; s < w.size(); ++s) t.mean += w[s] * all.points[s];
  for (std::size_t s = 0; s < w.size(); ++s)
    t.root += w[s] * (all.points[s] - t.mean) * (all.points[s] - t.mean).transpose();
  t.root.diagonal().array() += 1e-10;
  t.root = MatrixXd(t.root.llt().matrixL());
  return t;
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

WeightedPoints sample_by_importance(
    Index dimensions, int first, int size, int batches,
    const std::function<std::vector<double>(const std::vector<VectorXd>&)>& log_integrand) {
  std::mt19937_64 random(1);
  WeightedPoints all{even_points(dimensions, first), {}};
  all.log_weight.assign(all.points.size(), -std::log(first));
  std::vector<double> values = log_integrand(all.points);
  std::vector<Student> proposals;
  const auto uniform = [&random] { return (static_cast<double>(random() >> 11u) + 0.5) * 0x1p-53; };
  const auto normal = [&] {
    return std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
  };
  for (int b = 0; b < batches; ++b) {
    if (!std::ranges::any_of(values, [](double v) { return std::isfinite(v); })) break;
    proposals.push_back(student_of(all, values));
    const Student& t = proposals.back();
    std::vector<VectorXd> batch;
    while (batch.size() < static_cast<std::size_t>(size)) {
      double chi = 0.0;
      for (int i = 0; i < static_cast<int>(freedom); ++i) chi += std::pow(normal(), 2);
      VectorXd z(dimensions);
      for (Index j = 0; j < dimensions; ++j) z[j] = normal();
      const VectorXd u = t.mean + t.root * z * std::sqrt(freedom / chi);
      batch.push_back(u);
    }
    std::vector<VectorXd> inside;
    for (const VectorXd& u : batch)
      if (u.minCoeff() >= 0.0 && u.maxCoeff() <= 1.0) inside.push_back(u);
    const std::vector<double> more = log_integrand(inside);
    all.points.insert(all.points.end(), inside.begin(), inside.end());
    values.insert(values.end(), more.begin(), more.end());
    all.log_weight.clear();
    for (const VectorXd& u : all.points) {
      std::vector<double> densities{std::log(first)};
      for (const Student& p : proposals) densities.push_back(std::log(size) + p.log_density(u));
      all.log_weight.push_back(-log_sum(densities));
    }
  }
  return all;
}

}  // namespace snare::identification
