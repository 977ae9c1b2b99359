#include "coupling/contact/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// |a| with its derivatives; on a = 0, where there are none, the direction x stands for the gradient.
DistanceField distance_along(const Vector3d& a, const Matrix3d& space, double radius) {
  const double r = a.norm();
  if (r == 0.0) return {-radius, Vector3d::UnitX(), Matrix3d::Zero()};
  const Vector3d n = a / r;
  return {r - radius, n, (space - n * n.transpose()) / r};
}

constexpr int chords = 36;  // of a drawn circle

Eigen::Matrix3Xd exchanged(const Eigen::Matrix3Xd& line, int i, int j) {
  Eigen::Matrix3Xd result = line;
  result.row(i).swap(result.row(j));
  return result;
}

}  // namespace

std::vector<std::shared_ptr<const ContactShape>> pieces_of(const std::shared_ptr<const ContactShape>& shape,
                                                           double wire_radius) {
  std::vector<std::shared_ptr<const ContactShape>> pieces = shape->pieces(wire_radius);
  if (pieces.empty()) pieces.push_back(shape);
  return pieces;
}

Eigen::Matrix3Xd circle_drawing(double radius, double height, int count) {
  Eigen::Matrix3Xd line(3, count + 1);
  for (int k = 0; k <= count; ++k) {
    const double a = 2.0 * std::numbers::pi * k / count;
    line.col(k) << radius * std::cos(a), radius * std::sin(a), height;
  }
  return line;
}

std::vector<Eigen::Matrix3Xd> Ball::drawing() const {
  const Eigen::Matrix3Xd circle = circle_drawing(radius_, 0.0, chords);
  return {circle, exchanged(circle, 0, 2), exchanged(circle, 1, 2)};
}

std::vector<Eigen::Matrix3Xd> HalfSpace::drawing() const {
  const Eigen::Matrix3Xd side =
      drawn_ * (Matrix3d() << -1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 0.0, 0.0, 0.0).finished();
  return {side, -side};
}

std::vector<Eigen::Matrix3Xd> EndlessCylinder::drawing() const {
  return {circle_drawing(radius_, 0.0, chords)};
}

// Both ends, and the cut along two planes through the axis.
std::vector<Eigen::Matrix3Xd> Capsule::drawing() const {
  Eigen::Matrix3Xd cut = exchanged(circle_drawing(radius_, 0.0, chords), 1, 2);
  for (Eigen::Index k = 0; k < cut.cols(); ++k) cut(2, k) += 2 * k < chords ? half_length_ : -half_length_;
  cut.conservativeResize(3, cut.cols() + 1);
  cut.rightCols<1>() = cut.col(0);
  return {cut, exchanged(cut, 0, 1), circle_drawing(radius_, -half_length_, chords),
          circle_drawing(radius_, half_length_, chords)};
}

namespace {
constexpr double round_off = 1e-12;  // of directions [-], and of places [m]
}  // namespace

bool is_across_axis(const Vector3d& n) {
  return std::abs(n.x()) <= round_off && std::abs(n.y()) <= round_off;
}

bool has_axis(const Vector3d& n, double offset) {
  return std::abs(n.z()) <= round_off && std::abs(offset) <= round_off;
}

bool Ball::is_mirrored(const Vector3d& /*n*/, double offset) const {
  return std::abs(offset) <= round_off;
}

bool HalfSpace::is_mirrored(const Vector3d& n, double /*offset*/) const {
  return std::abs(n.z()) <= round_off;
}

bool EndlessCylinder::is_mirrored(const Vector3d& n, double offset) const {
  return is_across_axis(n) || has_axis(n, offset);
}

bool Capsule::is_mirrored(const Vector3d& n, double offset) const {
  return std::abs(offset) <= round_off && (is_across_axis(n) || has_axis(n, offset));
}

DistanceField Ball::at(const Vector3d& p) const {
  return distance_along(p, Matrix3d::Identity(), radius_);
}

DistanceField HalfSpace::at(const Vector3d& p) const {
  return {p.z(), Vector3d::UnitZ(), Matrix3d::Zero()};
}

DistanceField EndlessCylinder::at(const Vector3d& p) const {
  return distance_along({p.x(), p.y(), 0.0}, Vector3d(1.0, 1.0, 0.0).asDiagonal(), radius_);
}

DistanceField Capsule::at(const Vector3d& p) const {
  const double along = std::clamp(p.z(), -half_length_, half_length_);
  const bool between = along == p.z();
  return distance_along(p - Vector3d(0.0, 0.0, along), Vector3d(1.0, 1.0, between ? 0.0 : 1.0).asDiagonal(),
                        radius_);
}

}  // namespace snare::coupling
