#pragma once

#include <Eigen/Core>

namespace snare::wire {

/// Unit tangent of an edge and a unit director d1 perpendicular to it; d2 = tangent x d1.
struct Frame {
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();
  Eigen::Vector3d director = Eigen::Vector3d::UnitY();
};

/// Some unit vector perpendicular to the unit vector `tangent`.
[[nodiscard]] Eigen::Vector3d any_normal(const Eigen::Vector3d& tangent);

/// Turns v, perpendicular to the unit vector `from`, by the smallest rotation that takes `from` to the unit
/// vector `to`:                                              theory.md (W.20); Bergou et al. 2008, sec. 4.2.2
///   P v = v - (v.to)/(1 + from.to) (from + to).
/// Not a number when the two are opposite.
[[nodiscard]] Eigen::Vector3d parallel_transport(const Eigen::Vector3d& v, const Eigen::Vector3d& from,
                                                 const Eigen::Vector3d& to);

/// The frame carried to a new unit tangent without turning about it; the director is made perpendicular and
/// of unit length anew, so that round-off does not add up over many steps.
[[nodiscard]] Frame transport(const Frame& frame, const Eigen::Vector3d& tangent);

/// The director d1 after a turn by `angle` [rad] about the tangent.
[[nodiscard]] Eigen::Vector3d turned_director(const Frame& frame, double angle);

/// Angle in (-pi, pi] by which the director of `before`, carried to the tangent of `after`, must still turn
/// about that tangent to become the director of `after` [rad], plus the multiple of 2 pi that brings it
/// nearest to `near`.                                        theory.md (W.21); Bergou et al. 2010, sec. 5.1
///
/// Given the value of the last state as `near`, it follows any number of turns as long as one step changes it
/// by less than pi.
[[nodiscard]] double reference_twist(const Frame& before, const Frame& after, double near);

}  // namespace snare::wire
