#include "coupling/dynamics/contact/bezier_wire.hpp"

#include "coupling/contact/curve.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

using Eigen::Vector4d;
using numerics::VectorView;

Vector4d bernstein(double u) {
  const double v = 1.0 - u;
  return {v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u};
}

Vector4d bernstein_slope(double u) {
  const double v = 1.0 - u;
  return {-3.0 * v * v, 3.0 * v * (v - 2.0 * u), 3.0 * u * (2.0 * v - u), 3.0 * u * u};
}

Vector4d bernstein_bend(double u) {
  const double v = 1.0 - u;
  return {6.0 * v, 6.0 * (u - 2.0 * v), 6.0 * (v - 2.0 * u), 6.0 * u};
}

double largest_bend(const BezierWire::Control& c) {
  return 6.0 * std::sqrt(std::max((c.col(0) - 2.0 * c.col(1) + c.col(2)).squaredNorm(),
                                  (c.col(1) - 2.0 * c.col(2) + c.col(3)).squaredNorm()));
}

BezierWire::BezierWire(const wire::RodPart& rod) : rod_(rod) {
  for (int e = 0; e + 1 < rod.vertices(); ++e) {
    Piece piece;
    piece.begin = rod.coordinate(e);
    piece.length = rod.coordinate(e + 1) - piece.begin;
    const CurveWeights w = curve_weights(rod, piece.begin);
    piece.first = w.first;
    // X = a0 + a1 u + a2 u^2 + ... at its beginning, and the vertex at its end.
    const Vector4d a1 = piece.length * w.slope;
    const Vector4d a2 = 0.5 * piece.length * piece.length * w.bend;
    piece.weights << w.value, w.value + a1 / 3.0, w.value + 2.0 / 3.0 * a1 + a2 / 3.0,
        Vector4d::Unit(e + 1 - w.first);
    largest_weight_sum_ = std::max(largest_weight_sum_, piece.weights.cwiseAbs().colwise().sum().maxCoeff());
    longest_ = std::max(longest_, piece.length);
    shortest_ = e == 0 ? piece.length : std::min(shortest_, piece.length);
    pieces_.push_back(piece);
  }
}

BezierWire::Control BezierWire::control(int element, const VectorView& y) const {
  const Piece& p = piece(element);
  return Eigen::Map<const Control>(y.data() + rod_.position_of(p.first)) * p.weights;
}

int BezierWire::element_at(double coordinate) const {
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), coordinate,
                                      [](double s, const Piece& p) { return s < p.begin; });
  return std::max(0, static_cast<int>(after - pieces_.begin()) - 1);
}

Vector4d BezierWire::value(int element, double u) const {
  return piece(element).weights * bernstein(u);
}

Vector4d BezierWire::slope(int element, double u) const {
  return piece(element).weights * bernstein_slope(u) / piece(element).length;
}

Vector4d BezierWire::bend(int element, double u) const {
  return piece(element).weights * bernstein_bend(u) / (piece(element).length * piece(element).length);
}

}  // namespace snare::coupling
