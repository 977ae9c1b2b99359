#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "numerics/cubic_spline.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::coupling {

/// Points along a wire at the start of a motion.
struct LinePoints {
  Eigen::Matrix3Xd places;          ///< (3, n) [m], n >= 2, no two neighbours in one place
  Eigen::Matrix3Xd velocities;      ///< (3, n) [m/s]
  std::vector<double> coordinates;  ///< from 0 on, ascending: material ones, or along the line [m]
};

/// More points on the curve that a spline over the lengths of their chords draws through points, with how far
/// they lie along it. What the points have as coordinates is not looked at.                  theory.md (M.37)
/// Throws std::domain_error where points lie too close for roundings.
[[nodiscard]] LinePoints measured_points(const LinePoints& points);

/// The line on which a wire begins a motion: cubic splines of its places and velocities over the material
/// coordinate S, as a lath would lie through the points.                                     theory.md (M.37)
class CentreLine {
 public:
  /// Throws std::domain_error where coordinates lie too close for roundings.
  explicit CentreLine(const LinePoints& points);

  [[nodiscard]] double length() const { return x_.front().knots().back(); }  ///< unstretched [m]
  /// Place [m] at a coordinate [m].
  [[nodiscard]] Eigen::Vector3d place(double s) const { return of(x_, s, &numerics::HermiteCurve::value); }
  /// Velocity there [m/s].
  [[nodiscard]] Eigen::Vector3d velocity(double s) const { return of(v_, s, &numerics::HermiteCurve::value); }
  /// Unit vector of increasing coordinate [-].
  [[nodiscard]] Eigen::Vector3d direction(double s) const { return slope(s).normalized(); }
  /// |x'| - 1 [-].
  [[nodiscard]] double stretch(double s) const { return slope(s).norm() - 1.0; }
  /// Of the line in space [1/m].
  [[nodiscard]] double curvature(double s) const;

 private:
  using Curves = std::vector<numerics::HermiteCurve>;  // of x, y, z
  using Evaluation = double (numerics::HermiteCurve::*)(double) const noexcept;
  [[nodiscard]] static Eigen::Vector3d of(const Curves& curves, double s, Evaluation what);
  [[nodiscard]] Eigen::Vector3d slope(double s) const { return of(x_, s, &numerics::HermiteCurve::slope); }

  Curves x_, v_;
};

/// Lays a wire of the line's length onto it, without twist: places and velocities of its vertices, and its
/// ends, which hold the directions that the line has there.
void begin_on(const CentreLine& line, MotionWire& wire);

}  // namespace snare::coupling
