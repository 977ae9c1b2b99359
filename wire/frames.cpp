#include "wire/frames.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace snare::wire {

using Eigen::Vector3d;

Vector3d any_normal(const Vector3d& tangent) {
  // The axis that is farthest from the tangent.
  Eigen::Index smallest = 0;
  tangent.cwiseAbs().minCoeff(&smallest);
  return tangent.cross(Vector3d::Unit(smallest)).normalized();
}

Vector3d parallel_transport(const Vector3d& v, const Vector3d& from, const Vector3d& to) {
  return v - (v.dot(to) / (1.0 + from.dot(to))) * (from + to);
}

Frame transport(const Frame& frame, const Vector3d& tangent) {
  Vector3d director = parallel_transport(frame.director, frame.tangent, tangent);
  director -= tangent.dot(director) * tangent;
  director *= 1.0 / std::sqrt(director.squaredNorm());
  return {tangent, director};
}

Vector3d turned_director(const Frame& frame, double angle) {
  return std::cos(angle) * frame.director + std::sin(angle) * frame.tangent.cross(frame.director);
}

double reference_twist(const Frame& before, const Frame& after, double near) {
  using std::numbers::pi;
  const Vector3d carried = parallel_transport(before.director, before.tangent, after.tangent);
  const double sine = after.tangent.dot(carried.cross(after.director));
  const double angle = std::atan2(sine, carried.dot(after.director));
  const double gap = near - angle;
  return std::abs(gap) <= pi ? angle : angle + 2.0 * pi * std::round(gap / (2.0 * pi));
}

}  // namespace snare::wire
