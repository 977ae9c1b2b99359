#include "coupling/dynamics/contact/foot_point.hpp"

#include "base/index.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace snare::coupling {

using Eigen::Vector3d;

void CubicPieces::set(int element, const BezierWire::Control& b) {
  auto& c = pieces_[base::at(element)];
  controls_[base::at(element)] = b;
  c.col(0) = b.col(0);
  c.col(1) = 3.0 * (b.col(1) - b.col(0));
  c.col(2) = 3.0 * (b.col(0) - 2.0 * b.col(1) + b.col(2));
  c.col(3) = b.col(3) - b.col(0) + 3.0 * (b.col(1) - b.col(2));
}

Vector3d CubicPieces::value(int element, double u) const {
  const auto& c = pieces_[base::at(element)];
  return c.col(0) + u * (c.col(1) + u * (c.col(2) + u * c.col(3)));
}

Vector3d CubicPieces::slope(int element, double u) const {
  const auto& c = pieces_[base::at(element)];
  return c.col(1) + u * (2.0 * c.col(2) + 3.0 * u * c.col(3));
}

Vector3d CubicPieces::bend(int element, double u) const {
  const auto& c = pieces_[base::at(element)];
  return 2.0 * c.col(2) + 6.0 * u * c.col(3);
}

double CubicPieces::way(int element) const {
  const BezierWire::Control& b = control(element);
  return (b.rightCols<3>() - b.leftCols<3>()).colwise().norm().sum();
}

bool parted(const CubicPieces& own, int element, const CubicPieces& other, int first, int last,
            double distance) {
  const BezierWire::Control& c = own.control(element);
  const Vector3d n =
      (c.col(3) - c.col(0)).cross(other.control(last).col(3) - other.control(first).col(0)).normalized();
  const Eigen::Vector4d of_own = c.transpose() * n;
  Eigen::Vector4d low = other.control(first).transpose() * n, high = low;
  for (int e = first + 1; e <= last; ++e) {
    const Eigen::Vector4d of_other = other.control(e).transpose() * n;
    low = low.cwiseMin(of_other);
    high = high.cwiseMax(of_other);
  }
  return low.minCoeff() - of_own.maxCoeff() > distance || of_own.minCoeff() - high.maxCoeff() > distance;
}

namespace {

/// Zero of (X - p).X' between a negative value at 0 and a positive one at 1: Newton's method, halving where
/// it leaves the interval.
double foot_within(const CubicPieces& pieces, int element, const Vector3d& p, double at_0, double at_1) {
  constexpr double sharp = 1e-14;
  double low = 0.0, high = 1.0;
  double u = at_0 / (at_0 - at_1);
  for (int k = 0; k < 60; ++k) {
    const Vector3d apart = pieces.value(element, u) - p;
    const Vector3d slope = pieces.slope(element, u);
    const double q = apart.dot(slope);
    (q < 0.0 ? low : high) = u;
    const double rise = slope.squaredNorm() + apart.dot(pieces.bend(element, u));
    double next = rise > 0.0 ? u - q / rise : low - 1.0;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double change = std::abs(next - u);
    u = next;
    if (change <= sharp) break;
  }
  return u;
}

}  // namespace

FootPoint foot_point(const CubicPieces& pieces, int first, int last, const Vector3d& p) {
  // Vertex k is the beginning of element k.
  const auto vertex = [&](int k) { return k <= last ? pieces.value(k, 0.0) : pieces.value(last, 1.0); };
  int nearest = first;
  double least = (vertex(first) - p).squaredNorm();
  for (int k = first + 1; k <= last + 1; ++k) {
    const double square = (vertex(k) - p).squaredNorm();
    if (square < least) {
      least = square;
      nearest = k;
    }
  }
  const auto rise = [&](int e, double u) { return (pieces.value(e, u) - p).dot(pieces.slope(e, u)); };
  double here = nearest <= last ? rise(nearest, 0.0) : rise(last, 1.0);
  if (here <= 0.0) {
    for (int e = nearest; e <= last; ++e) {
      here = rise(e, 0.0);
      const double next = rise(e, 1.0);
      if (next > 0.0)
        return here < 0.0 ? FootPoint{e, foot_within(pieces, e, p, here, next), false}
                          : FootPoint{e, 0.0, false};
    }
    return {last, 1.0, true};
  }
  for (int e = nearest - 1; e >= first; --e) {
    const double next = rise(e, 0.0);
    here = rise(e, 1.0);
    if (next <= 0.0)
      return next < 0.0 ? FootPoint{e, foot_within(pieces, e, p, next, here), false}
                        : FootPoint{e, 0.0, false};
  }
  return {first, 0.0, true};
}

}  // namespace snare::coupling
