#include "coupling/dynamics/model/centre_line.hpp"

#include "wire/frames.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace snare::coupling {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using numerics::HermiteCurve;

namespace {

std::vector<HermiteCurve> curves_through(const Matrix3Xd& values, const std::vector<double>& knots) {
  std::vector<HermiteCurve> curves;
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd row = values.row(k);
    curves.emplace_back(knots, std::vector<double>(row.begin(), row.end()));
  }
  return curves;
}

/// Unit vector across a direction: the axis of the world that is least along it, made perpendicular. Of a
/// wire in a plane across an axis it is that axis.
Vector3d director_across(const Vector3d& direction) {
  int axis = 0;
  for (const int k : {1, 2}) {
    if (std::abs(direction[k]) < std::abs(direction[axis])) axis = k;
  }
  return (Vector3d::Unit(axis) - direction[axis] * direction).normalized();
}

/// Of a curve between two of its coordinates [m], by Simpson's rule.
double length_between(const CentreLine& curve, double from, double to) {
  constexpr int pieces = 8;
  double sum = 0.0;
  for (int j = 0; j <= pieces; ++j) {
    const double weight = j == 0 || j == pieces ? 1.0 : (j % 2 == 1 ? 4.0 : 2.0);
    sum += weight * (1.0 + curve.stretch(from + j * (to - from) / pieces));
  }
  return sum * (to - from) / (3.0 * pieces);
}

}  // namespace

CentreLine::CentreLine(const LinePoints& points)
    : x_(curves_through(points.places, points.coordinates)),
      v_(curves_through(points.velocities, points.coordinates)) {}

Vector3d CentreLine::of(const Curves& curves, double s, Evaluation what) {
  return {(curves[0].*what)(s), (curves[1].*what)(s), (curves[2].*what)(s)};
}

double CentreLine::curvature(double s) const {
  const Vector3d first = slope(s), second = of(x_, s, &HermiteCurve::curvature);
  const double size = first.norm();
  return first.cross(second).norm() / (size * size * size);
}

// Between the new points the curve turns so little that a spline over its length has the speed one.
LinePoints measured_points(const LinePoints& points) {
  const Eigen::Index n = points.places.cols();
  constexpr Eigen::Index most_parts = 64, enough = 4000;
  const Eigen::Index parts = std::clamp<Eigen::Index>(enough / n, 1, most_parts), count = (n - 1) * parts + 1;
  LinePoints chords{points.places, points.velocities, {0.0}};
  for (Eigen::Index i = 1; i < n; ++i)
    chords.coordinates.push_back(chords.coordinates.back() +
                                 (points.places.col(i) - points.places.col(i - 1)).norm());
  const CentreLine curve(chords);
  LinePoints finer{Matrix3Xd(3, count), Matrix3Xd(3, count), {0.0}};
  Eigen::Index next = 0;
  const auto put = [&](double at) {
    finer.places.col(next) = curve.place(at);
    finer.velocities.col(next++) = curve.velocity(at);
  };
  put(0.0);
  for (std::size_t i = 1; i < chords.coordinates.size(); ++i) {
    const double from = chords.coordinates[i - 1];
    const double width = (chords.coordinates[i] - from) / static_cast<double>(parts);
    for (Eigen::Index k = 0; k < parts; ++k) {
      const double at = from + static_cast<double>(k) * width;
      const double next_at =
          k + 1 == parts ? chords.coordinates[i] : at + width;  // the points themselves, without round-off
      finer.coordinates.push_back(finer.coordinates.back() + length_between(curve, at, next_at));
      put(next_at);
    }
  }
  return finer;
}

void begin_on(const CentreLine& line, MotionWire& wire) {
  wire::RodInMotion& rod = wire.rod;
  const wire::MaterialMesh mesh = rod.mesh();
  const wire::Controls controls = rod.controls();
  const int last = mesh.vertices() - 1;
  wire.positions.resize(3, mesh.vertices());
  wire.velocities.resize(3, mesh.vertices());
  for (int i = 0; i <= last; ++i) {
    const double s = i == last ? line.length() : mesh.coordinate(i, controls);
    wire.positions.col(i) = line.place(s);
    wire.velocities.col(i) = line.velocity(s);
  }
  if (wire.velocities.isZero(0.0)) wire.velocities.resize(3, 0);  // with its carriers
  const Vector3d along = line.direction(0.0);
  wire::Frame frame{along, director_across(along)};
  const auto set = [&frame](wire::SpatialEnd& end, const Vector3d& place) {
    end.position = place;
    end.direction = frame.tangent;
    end.director = frame.director;
  };
  set(rod.properties.left, wire.positions.col(0));
  for (int e = 0; e < last; ++e)
    frame = wire::transport(frame, (wire.positions.col(e + 1) - wire.positions.col(e)).normalized());
  frame = wire::transport(frame, line.direction(line.length()));
  set(rod.properties.right, wire.positions.col(last));
}

}  // namespace snare::coupling
