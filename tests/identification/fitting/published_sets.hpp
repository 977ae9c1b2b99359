#pragma once

#include "identification/fitting/published_fit.hpp"
#include "tests/support/declared_wire.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace snare::test {

constexpr double published_range = 4e-3;  // [m]

inline std::vector<double> published_travels(int readings) {
  std::vector<double> d;
  for (int i = 0; i < readings; ++i) d.push_back(published_range * i / (readings - 1));
  return d;
}

inline identification::Series published(const identification::QuadraticLaw& law, int readings) {
  identification::Series s;
  s.name = "s";
  s.test = declared_wire(65.0 * mm, 6.0 * mm);
  s.test.travel = published_travels(readings);
  s.law = law;
  return s;
}

/// Three curves that are linear in five numbers: two coefficients for all, and a zero of the travel for each.
/// Forces up to 15 N, 0.1 N rms of them off the parabola.
struct LinearWire {
  std::vector<Eigen::VectorXd> force;
  std::vector<Eigen::MatrixXd> by;

  explicit LinearWire(int readings) {
    const std::vector<double> d = published_travels(readings);
    for (int k = 0; k < 3; ++k) {
      const double a = (7.0 + k) * 1e5;
      const double b = 2e7 * (1.0 + k);
      Eigen::VectorXd f(readings);
      Eigen::MatrixXd g = Eigen::MatrixXd::Zero(readings, 5);
      for (int i = 0; i < readings; ++i) {
        const double x = d[static_cast<std::size_t>(i)];
        const double square = a * x * x;
        const double cubic = b * x * x * x * (1.0 + 50.0 * x);
        f[i] = square + cubic;
        g(i, 0) = square;
        g(i, 1) = cubic;
        g(i, 2 + k) = 1e-3 * (2.0 * a * x + 3.0 * b * x * x);
      }
      force.push_back(f);
      by.push_back(g);
    }
  }

  /// What is printed of readings with noise of `sigma` [N], compared with these curves plus `off` [N] at half
  /// the travel.
  [[nodiscard]] identification::PublishedDeviance deviance(double sigma, int digits, std::mt19937_64& random,
                                                           double off = 0.0) const {
    std::normal_distribution<double> normal;
    std::vector<identification::Series> series;
    std::vector<identification::LinearCurve> curves;
    const auto n = static_cast<int>(force.front().size());
    const std::vector<double> d = published_travels(n);
    for (const Eigen::VectorXd& f : force) {
      Eigen::VectorXd y = f;
      for (int i = 0; i < n; ++i) {
        const double x = d[static_cast<std::size_t>(i)] / published_range;
        y[i] += sigma * normal(random) + off * (series.empty() ? 4.0 : -4.0) * x * (1.0 - x);
      }
      series.push_back(published(identification::printed_law(d, y, digits), n));
    }
    const std::vector<identification::PublishedSeries> numbers = identification::published_series(series);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      curves.push_back(identification::linear_curve(numbers[k], force[k], by[k]));
    }
    return {numbers, curves, identification::PublishedScatter::common};
  }
};

/// Share of values below a level.
inline double share_below(const std::vector<double>& values, double level) {
  return static_cast<double>(std::ranges::count_if(values, [&](double v) { return v < level; })) /
         static_cast<double>(values.size());
}

}  // namespace snare::test
