#pragma once

#include "numerics/lanes.hpp"

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
template <class S>
[[nodiscard]] numerics::Vector3<S> parallel_transport(const numerics::Vector3<S>& v,
                                                      const numerics::Vector3<S>& from,
                                                      const numerics::Vector3<S>& to);

/// The director of a frame that is carried from one unit tangent to another without turning about it; it is
/// made perpendicular and of unit length again, so that round-off does not add up over many steps.
template <class S>
[[nodiscard]] numerics::Vector3<S> transported(const numerics::Vector3<S>& director,
                                               const numerics::Vector3<S>& from,
                                               const numerics::Vector3<S>& to);
[[nodiscard]] inline Frame transport(const Frame& frame, const Eigen::Vector3d& tangent) {
  return {tangent, transported<double>(frame.director, frame.tangent, tangent)};
}

/// The director d1 after a turn by `angle` [rad] about the tangent.
template <class S>
[[nodiscard]] numerics::Vector3<S> turned(const numerics::Vector3<S>& director,
                                          const numerics::Vector3<S>& tangent, const S& angle);
[[nodiscard]] inline Eigen::Vector3d turned_director(const Frame& frame, double angle) {
  return turned<double>(frame.director, frame.tangent, angle);
}

/// Angle in (-pi, pi] by which the director of the frame before, carried to the tangent of the one after,
/// must still turn about that tangent to become the director of the frame after [rad], plus the multiple of 2
/// pi that brings it nearest to `near`.                                        theory.md (W.21); Bergou et
/// al. 2010, sec. 5.1
///
/// Given the value of the last state as `near`, it follows any number of turns as long as one step changes it
/// by less than pi.
template <class S>
[[nodiscard]] S twist_between(const numerics::Vector3<S>& tangent_before,
                              const numerics::Vector3<S>& director_before,
                              const numerics::Vector3<S>& tangent_after,
                              const numerics::Vector3<S>& director_after, const S& near);
[[nodiscard]] inline double reference_twist(const Frame& before, const Frame& after, double near) {
  return twist_between<double>(before.tangent, before.director, after.tangent, after.director, near);
}

// Here, for the compiler to put in where wires in motion spend their time.

template <class S>
[[gnu::always_inline]] inline numerics::Vector3<S> parallel_transport(const numerics::Vector3<S>& v,
                                                                      const numerics::Vector3<S>& from,
                                                                      const numerics::Vector3<S>& to) {
  return v - (v.dot(to) / (1.0 + from.dot(to))) * (from + to);
}

template <class S>
[[gnu::always_inline]] inline numerics::Vector3<S> transported(const numerics::Vector3<S>& director,
                                                               const numerics::Vector3<S>& from,
                                                               const numerics::Vector3<S>& to) {
  numerics::Vector3<S> carried = parallel_transport<S>(director, from, to);
  carried -= to.dot(carried) * to;
  carried *= 1.0 / numerics::sqrt(carried.squaredNorm());
  return carried;
}

template <class S>
[[gnu::always_inline]] inline numerics::Vector3<S> turned(const numerics::Vector3<S>& director,
                                                          const numerics::Vector3<S>& tangent,
                                                          const S& angle) {
  const numerics::SineCosine<S> of = numerics::sine_cosine(angle);
  return of.cosine * director + of.sine * tangent.cross(director);
}

template <class S>
[[gnu::always_inline]] inline S twist_between(const numerics::Vector3<S>& tangent_before,
                                              const numerics::Vector3<S>& director_before,
                                              const numerics::Vector3<S>& tangent_after,
                                              const numerics::Vector3<S>& director_after, const S& near) {
  using std::numbers::pi;
  const numerics::Vector3<S> carried = parallel_transport<S>(director_before, tangent_before, tangent_after);
  const S sine = tangent_after.dot(carried.cross(director_after));
  const S angle = numerics::polar_angle(sine, carried.dot(director_after));
  const S gap = near - angle;
  if (numerics::none_below(S(pi), numerics::abs(gap))) return angle;
  return angle + numerics::each(gap, [](double g) { return 2.0 * pi * std::round(g / (2.0 * pi)); });
}

}  // namespace snare::wire
