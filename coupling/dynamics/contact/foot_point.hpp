#pragma once

#include "coupling/dynamics/contact/bezier_wire.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace snare::coupling {

/// The elements of a wire at a state as cubics X(u) = c_0 + c_1 u + c_2 u^2 + c_3 u^3, u from 0 to 1.
class CubicPieces {
 public:
  CubicPieces() = default;
  explicit CubicPieces(int elements)
      : pieces_(static_cast<std::size_t>(elements)), controls_(pieces_.size()) {}
  /// Of one element, by its control points.
  void set(int element, const BezierWire::Control& control);

  /// How many cubics there are, one an element.
  [[nodiscard]] int elements() const { return static_cast<int>(pieces_.size()); }
  /// X(u) [m], u in [0, 1].
  [[nodiscard]] Eigen::Vector3d value(int element, double u) const;
  [[nodiscard]] Eigen::Vector3d slope(int element, double u) const;  ///< dX/du [m]
  [[nodiscard]] Eigen::Vector3d bend(int element, double u) const;   ///< d2X/du2 [m]
  /// The largest |d2X/du2| on an element [m], which is at one of its ends.
  [[nodiscard]] double largest_bend(int element) const {
    return std::max(bend(element, 0.0).norm(), bend(element, 1.0).norm());
  }
  /// A bound of an element's length [m].
  [[nodiscard]] double way(int element) const;
  /// The control points of an element, in whose hull it lies [m].
  [[nodiscard]] const BezierWire::Control& control(int element) const {
    return controls_[static_cast<std::size_t>(element)];
  }

 private:
  std::vector<Eigen::Matrix<double, 3, 4>> pieces_;
  std::vector<BezierWire::Control> controls_;
};
/// Whether an element of one wire and a run of elements of another are further apart than a distance [m], as
/// a plane between them shows whose normal is perpendicular to both; false says nothing.     theory.md (G.13)
[[nodiscard]] bool parted(const CubicPieces& own, int element, const CubicPieces& other, int first, int last,
                          double distance);

/// The point of a wire that is nearest to a given one.
struct FootPoint {
  int element = 0;
  double u = 0.0;  ///< along the element, from 0 to 1 [-]
  /// An end of the wire or of the elements that were looked through: (X - p).X' is not zero.
  bool stands = false;
};
/// The local minimum of the distance to p [m] that is downhill of the nearest of the vertices of elements
/// first ... last.
///                                                                                           theory.md (G.12)
[[nodiscard]] FootPoint foot_point(const CubicPieces& pieces, int first, int last, const Eigen::Vector3d& p);

}  // namespace snare::coupling
