#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

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

// Here, for the compiler to put in where wires in motion spend their time.

inline Eigen::Vector3d parallel_transport(const Eigen::Vector3d& v, const Eigen::Vector3d& from,
                                          const Eigen::Vector3d& to) {
  return v - (v.dot(to) / (1.0 + from.dot(to))) * (from + to);
}

inline Frame transport(const Frame& frame, const Eigen::Vector3d& tangent) {
  Eigen::Vector3d director = parallel_transport(frame.director, frame.tangent, tangent);
  director -= tangent.dot(director) * tangent;
  director *= 1.0 / std::sqrt(director.squaredNorm());
  return {tangent, director};
}

inline Eigen::Vector3d turned_director(const Frame& frame, double angle) {
  return std::cos(angle) * frame.director + std::sin(angle) * frame.tangent.cross(frame.director);
}

inline double reference_twist(const Frame& before, const Frame& after, double near) {
  using std::numbers::pi;
  const Eigen::Vector3d carried = parallel_transport(before.director, before.tangent, after.tangent);
  const double sine = after.tangent.dot(carried.cross(after.director));
  const double angle = std::atan2(sine, carried.dot(after.director));
  const double gap = near - angle;
  return std::abs(gap) <= pi ? angle : angle + 2.0 * pi * std::round(gap / (2.0 * pi));
}

}  // namespace snare::wire
