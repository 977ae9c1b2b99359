#include "numerics/cubic_spline.hpp"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace snare::numerics {

namespace {

/// Row of a matrix with the derivative at `at` of the polynomial through some knots.
void lagrange_derivative(const std::vector<double>& knots, std::size_t first, std::size_t count, double at,
                         Eigen::MatrixXd& matrix, Eigen::Index row) {
  for (std::size_t a = first; a < first + count; ++a) {
    double sum = 0.0;
    for (std::size_t b = first; b < first + count; ++b) {
      if (b == a) continue;
      double product = 1.0 / (knots[a] - knots[b]);
      for (std::size_t c = first; c < first + count; ++c) {
        if (c != a && c != b) product *= (at - knots[c]) / (knots[a] - knots[c]);
      }
      sum += product;
    }
    matrix(row, static_cast<Eigen::Index>(a)) += sum;
  }
}

/// left m = right v for the slopes m of a spline through v at four knots or more; three entries a row.
struct SplineEquations {
  Eigen::SparseMatrix<double> left, right;
};

SplineEquations spline_equations(const std::vector<double>& knots, SplineEnd upper) {
  const auto size = static_cast<int>(knots.size());
  std::vector<Eigen::Triplet<double>> left, right;
  const auto width = [&knots](int cell) {
    return knots[static_cast<std::size_t>(cell) + 1] - knots[static_cast<std::size_t>(cell)];
  };
  // Continuous second derivative at the inner knots, h the widths of the cells:
  //   m[i-1]/h[i-1] + 2 (1/h[i-1] + 1/h[i]) m[i] + m[i+1]/h[i] = 3 (v[i] - v[i-1])/h[i-1]^2 + 3 (v[i+1]
  //     - v[i])/h[i]^2
  for (int i = 1; i + 1 < size; ++i) {
    const double before = 1.0 / width(i - 1);
    const double after = 1.0 / width(i);
    left.emplace_back(i, i - 1, before);
    left.emplace_back(i, i, 2.0 * (before + after));
    left.emplace_back(i, i + 1, after);
    right.emplace_back(i, i - 1, -3.0 * before * before);
    right.emplace_back(i, i, 3.0 * (before * before - after * after));
    right.emplace_back(i, i + 1, 3.0 * after * after);
  }
  // Continuous third derivative at the knot next to the end: (m[i] + m[i+1] - 2 secant)/h^2 on both its
  // sides.
  const auto not_a_knot = [&](int row, int cell) {
    for (const double sign : {1.0, -1.0}) {
      const int c = sign > 0.0 ? cell : cell + 1;
      const double w = sign / (width(c) * width(c));
      left.emplace_back(row, c, w);
      left.emplace_back(row, c + 1, w);
      right.emplace_back(row, c, -2.0 * w / width(c));
      right.emplace_back(row, c + 1, 2.0 * w / width(c));
    }
  };
  not_a_knot(0, 0);
  if (upper == SplineEnd::not_a_knot)
    not_a_knot(size - 1, size - 3);
  else
    left.emplace_back(size - 1, size - 1, 1.0);
  SplineEquations equations{Eigen::SparseMatrix<double>(size, size), Eigen::SparseMatrix<double>(size, size)};
  equations.left.setFromTriplets(left.begin(), left.end());
  equations.right.setFromTriplets(right.begin(), right.end());
  return equations;
}  // NOLINT(clang-analyzer-unix.Malloc): the matrices free what they hold

/// Slopes for every column of `values`.
Eigen::MatrixXd slopes_of(const std::vector<double>& knots, const Eigen::MatrixXd& values, SplineEnd upper) {
  const std::size_t n = knots.size();
  const auto size = static_cast<Eigen::Index>(n);
  if (n == 1) return Eigen::MatrixXd::Zero(size, values.cols());
  if (n <= 3) {
    Eigen::MatrixXd by = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t i = 0; i < n; ++i)
      lagrange_derivative(knots, 0, n, knots[i], by, static_cast<Eigen::Index>(i));
    if (upper == SplineEnd::level) by.row(size - 1).setZero();
    return by * values;
  }
  const SplineEquations equations = spline_equations(knots, upper);
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(equations.left);
  if (factor.info() !=
      Eigen::
          Success)  // knots that roundings do not tell from each other; solving would read what is not there
    throw std::domain_error(
        fmt::format("a spline's {} knots from {} to {} lie too close", n, knots.front(), knots.back()));
  return factor.solve(Eigen::MatrixXd(equations.right * values));
}

}  // namespace

Eigen::MatrixXd spline_slopes(const std::vector<double>& knots, SplineEnd upper) {
  const auto size = static_cast<Eigen::Index>(knots.size());
  return slopes_of(knots, Eigen::MatrixXd::Identity(size, size), upper);
}

HermiteCurve::HermiteCurve(std::vector<double> knots, std::vector<double> values, std::vector<double> slopes)
    : knots_(std::move(knots)), values_(std::move(values)), slopes_(std::move(slopes)) {
  assert(knots_.size() >= 2 && values_.size() == knots_.size() && slopes_.size() == knots_.size());
  cells_per_x_ = static_cast<double>(knots_.size() - 1) / (knots_.back() - knots_.front());
  area_.assign(knots_.size(), 0.0);
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const double h = knots_[i + 1] - knots_[i];
    area_[i + 1] =
        area_[i] + h * (0.5 * (values_[i] + values_[i + 1]) + h / 12.0 * (slopes_[i] - slopes_[i + 1]));
  }
}

HermiteCurve::HermiteCurve(std::vector<double> knots, std::vector<double> values)
    : HermiteCurve(knots, values, [&] {
        const Eigen::VectorXd m = slopes_of(
            knots, Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())),
            SplineEnd::not_a_knot);
        return std::vector<double>(m.begin(), m.end());
      }()) {}

double HermiteCurve::value(double x) const noexcept {
  const std::size_t i = cell(x);
  const double h = knots_[i + 1] - knots_[i];
  const double t = (x - knots_[i]) / h;
  const double u = 1.0 - t;
  return u * u * ((1.0 + 2.0 * t) * values_[i] + h * t * slopes_[i]) +
         t * t * ((1.0 + 2.0 * u) * values_[i + 1] - h * u * slopes_[i + 1]);
}

double HermiteCurve::slope(double x) const noexcept {
  const std::size_t i = cell(x);
  const double h = knots_[i + 1] - knots_[i];
  const double t = (x - knots_[i]) / h;
  const double u = 1.0 - t;
  return 6.0 * t * u * (values_[i + 1] - values_[i]) / h + u * (u - 2.0 * t) * slopes_[i] +
         t * (t - 2.0 * u) * slopes_[i + 1];
}

double HermiteCurve::curvature(double x) const noexcept {
  const std::size_t i = cell(x);
  const double h = knots_[i + 1] - knots_[i];
  const double t = (x - knots_[i]) / h;
  return 6.0 * (1.0 - 2.0 * t) * (values_[i + 1] - values_[i]) / (h * h) +
         ((6.0 * t - 4.0) * slopes_[i] + (6.0 * t - 2.0) * slopes_[i + 1]) / h;
}

double HermiteCurve::integral(double x) const noexcept {
  const std::size_t i = cell(x);
  const double h = knots_[i + 1] - knots_[i];
  const double t = (x - knots_[i]) / h;
  const double t2 = t * t;
  const double t3 = t2 * t;
  const double t4 = t2 * t2;
  return area_[i] + h * ((t - t3 + 0.5 * t4) * values_[i] + (t3 - 0.5 * t4) * values_[i + 1] +
                         h * ((0.5 * t2 - 2.0 / 3.0 * t3 + 0.25 * t4) * slopes_[i] +
                              (0.25 * t4 - t3 / 3.0) * slopes_[i + 1]));
}

std::vector<double> monotone_slopes(const std::vector<double>& knots, const std::vector<double>& values,
                                    std::vector<double> slopes) {
  const std::size_t n = knots.size();
  const auto secant = [&](std::size_t i) { return (values[i + 1] - values[i]) / (knots[i + 1] - knots[i]); };
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i > 0 ? secant(i - 1) : secant(0);
    const double after = i + 1 < n ? secant(i) : secant(n - 2);
    if (before * after <= 0.0) {
      slopes[i] = 0.0;
      continue;
    }
    const double most = 3.0 * std::min(std::abs(before), std::abs(after));
    const double sense = before > 0.0 ? 1.0 : -1.0;
    slopes[i] = sense * std::clamp(sense * slopes[i], 0.0, most);
  }
  return slopes;
}

}  // namespace snare::numerics
