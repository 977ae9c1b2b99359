#include "coupling/dynamics/centre_line.hpp"

#include "wire/frames.hpp"

#include <Eigen/Geometry>

#include <cassert>

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

/// Unit vector across a direction: the axis of the world that is least along it, made perpendicular. Of a wire in a plane across an
/// axis it is that axis.
Vector3d director_across(const Vector3d& direction) {
  int axis = 0;
  for (const int k : {1, 2}) {
    if (std::abs(direction[k]) < std::abs(direction[axis])) axis = k;
  }
  return (Vector3d::Unit(axis) - direction[axis] * direction).normalized();
}

}  // namespace

CentreLine::CentreLine(const Matrix3Xd& points, const Matrix3Xd& velocities, const std::vector<double>& coordinates)
    : x_(curves_through(points, coordinates)), v_(curves_through(velocities, coordinates)) {}

Vector3d CentreLine::of(const Curves& curves, double s, Evaluation what) {
  return {(curves[0].*what)(s), (curves[1].*what)(s), (curves[2].*what)(s)};
}

double CentreLine::curvature(double s) const {
  const Vector3d first = slope(s), second = of(x_, s, &HermiteCurve::curvature);
  const double size = first.norm();
  return first.cross(second).norm() / (size * size * size);
}

// Over the lengths of the chords the spline's speed differs from one by the square of what it turns between points; over its own
// arc lengths, by the fourth power.
std::vector<double> arc_lengths(const Matrix3Xd& points) {
  const auto n = static_cast<std::size_t>(points.cols());
  std::vector<double> lengths(n, 0.0);
  for (std::size_t i = 1; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    lengths[i] = lengths[i - 1] + (points.col(k) - points.col(k - 1)).norm();
  }
  constexpr int passes = 3,
                parts = 8;  // a piece of a cubic that turns by 45 degrees: to 1e-10 of its length by Simpson's rule
  const Matrix3Xd still = Matrix3Xd::Zero(3, points.cols());
  for (int pass = 0; pass < passes; ++pass) {
    const CentreLine line(points, still, lengths);
    std::vector<double> along(n, 0.0);
    for (std::size_t i = 1; i < n; ++i) {
      const double from = lengths[i - 1], step = (lengths[i] - from) / (2 * parts);
      double sum = 0.0;
      for (int j = 0; j <= 2 * parts; ++j) {
        const double weight = j == 0 || j == 2 * parts ? 1.0 : (j % 2 == 1 ? 4.0 : 2.0);
        sum += weight * (1.0 + line.stretch(from + j * step));
      }
      along[i] = along[i - 1] + sum * step / 3.0;
    }
    lengths = along;
  }
  return lengths;
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
