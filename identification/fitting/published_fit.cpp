#include "identification/fitting/published_fit.hpp"

#include "identification/fitting/prediction.hpp"
#include "identification/fitting/statistics.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

using Eigen::Index;

/// Columns d^2, d, 1 with d over the longest travel, so that they are of one size.
Eigen::MatrixXd quadratics(const std::vector<double>& travel, double longest) {
  Eigen::MatrixXd x(static_cast<Index>(travel.size()), 3);
  for (Index i = 0; i < x.rows(); ++i) {
    const double u = travel[static_cast<std::size_t>(i)] / longest;
    x.row(i) << u * u, u, 1.0;
  }
  return x;
}

double longest_of(const std::vector<double>& travel) {
  double longest = 0.0;
  for (const double d : travel) longest = std::max(longest, std::abs(d));
  return longest > 0.0 ? longest : 1.0;
}

/// Gram and Schmidt twice: orthonormal to roundings.
Eigen::MatrixXd orthonormal(Eigen::MatrixXd x) {
  for (Index k = 0; k < x.cols(); ++k) {
    for (int pass = 0; pass < 2; ++pass) {
      for (Index j = 0; j < k; ++j) x.col(k) -= x.col(j).dot(x.col(k)) * x.col(j);
    }
    const double norm = x.col(k).norm();
    if (norm > 0.0) x.col(k) /= norm;
  }
  return x;
}

double about_mean(const Eigen::VectorXd& y) {
  return (y.array() - y.mean()).square().sum();
}

/// One series: sums of squares of the lost readings about their fit, and of the computed curve about its own.
struct Comparison {
  FitComparison fit;
  double lost = 0.0;           // (1 - R^2) S_yy
  double curved = 0.0;         // |(I - H) F|^2
  double spread = 0.0;         // of the computed curve's parabola about its mean
  Eigen::VectorXd difference;  // Q^T (law - F)
  Eigen::Matrix3d inverse;     // (X^T X)^-1 in A, B, C
  double dof = 0.0;            // n - 3
};

Comparison compare(const Series& series, const std::vector<double>& force) {
  const std::vector<double>& travel = measured_displacement(series);
  const double longest = longest_of(travel);
  const Eigen::MatrixXd x = quadratics(travel, longest);
  const Eigen::MatrixXd q = orthonormal(x);
  const QuadraticLaw& law = *series.law;
  Eigen::VectorXd published(x.rows());
  for (Index i = 0; i < x.rows(); ++i) published[i] = law.force(travel[static_cast<std::size_t>(i)]);
  const Eigen::Map<const Eigen::VectorXd> f(force.data(), x.rows());
  const Eigen::Vector3d unit{1.0 / (longest * longest), 1.0 / longest, 1.0};
  const Eigen::Matrix3d inverse = (x.transpose() * x).inverse();
  const Eigen::Vector3d computed = unit.asDiagonal() * (inverse * (x.transpose() * f));
  Comparison c;
  c.fit.published = {law.a, law.b, law.c};
  c.fit.computed = {computed[0], computed[1], computed[2]};
  c.fit.published_r2 = law.r_squared;
  c.lost = (1.0 - law.r_squared) / law.r_squared * about_mean(published);
  const Eigen::VectorXd fitted = q * (q.transpose() * f);
  c.curved = (f - fitted).squaredNorm();
  c.spread = about_mean(fitted);
  c.difference = q.transpose() * (published - f);
  c.inverse = unit.asDiagonal() * inverse * unit.asDiagonal();
  c.dof = std::max(1.0, static_cast<double>(x.rows()) - 3.0);
  return c;
}

}  // namespace

Eigen::MatrixXd quadratic_basis(const std::vector<double>& travel) {
  return orthonormal(quadratics(travel, longest_of(travel))).transpose();
}

// With e the readings' noise and H the projection on the quadratics,
//   (1 - R^2) S_yy = |(I - H)(F + e)|^2, of mean |(I - H) F|^2 + (n - 3) sigma^2.
SummaryStatistics summary_statistics(const std::vector<Series>& series, const std::vector<std::vector<double>>& force,
                                     std::size_t numbers) {
  constexpr double least_noise = 0.25;  // of the lost squares: not all of them are the curve's
  SummaryStatistics result;
  result.numbers = numbers;
  std::vector<Comparison> all;
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (!series[k].law || force[k].size() != measured_displacement(series[k]).size() || force[k].size() < 4) continue;
    all.push_back(compare(series[k], force[k]));
  }
  if (all.empty()) return result;
  double squares = 0.0;
  double count = 0.0;
  for (Comparison& c : all) {
    const double own = std::max(c.lost - c.curved, least_noise * c.lost);
    c.fit.scatter = std::sqrt(own / c.dof);
    squares += own;
    count += c.dof;
  }
  const double variance = squares / count;
  result.scatter = std::sqrt(variance);
  for (Comparison& c : all) {
    const double own = c.fit.scatter * c.fit.scatter;
    c.fit.chi2 = own > 0.0 ? c.difference.squaredNorm() / own : 0.0;
    result.coefficients += c.fit.chi2;
    const double expected = c.curved + c.dof * variance;
    if (all.size() > 1 && variance > 0.0) {
      result.chi2 += std::pow(c.lost - expected, 2) / (2.0 * c.dof * variance * variance + 4.0 * c.curved * variance);
    }
    c.fit.computed_r2 = c.spread / (c.spread + expected);
    for (Index i = 0; i < 3; ++i) c.fit.deviation[static_cast<std::size_t>(i)] = std::sqrt(own * c.inverse(i, i));
    result.series.push_back(c.fit);
  }
  result.chi2 += result.coefficients;
  const auto laws = static_cast<double>(all.size());
  const double scatters = all.size() > 1 ? laws - 1.0 : 0.0;
  result.dof = 3.0 * laws + scatters - static_cast<double>(numbers);
  // Of a scatter that is a difference of squares, by its variance 2 (n - 3) sigma^4 + 4 sigma^2 |(I - H) F|^2.
  double known = 0.0;
  for (const Comparison& c : all) {
    const double own = c.fit.scatter * c.fit.scatter;
    known += own > 0.0 ? c.dof * c.dof / (c.dof + 2.0 * c.curved / own) : c.dof;
  }
  result.p = result.dof > 0.0 ? fisher_tail(result.chi2 / result.dof, result.dof, known) : 1.0;
  return result;
}

}  // namespace snare::identification
