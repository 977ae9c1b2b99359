#pragma once

#include "coupling/dynamics/model.hpp"

namespace snare::test {

/// A body at rest in the origin, with principal moments of inertia [kg m^2].
[[nodiscard]] inline coupling::MotionBody block(const char* name, double mass, const Eigen::Vector3d& moments) {
  coupling::MotionBody body;
  body.name = name;
  body.properties.mass = mass;
  body.properties.inertia = moments.asDiagonal();
  return body;
}

[[nodiscard]] constexpr coupling::MotionCarrier body_of(int index) {
  return {coupling::MotionCarrier::Kind::body, index, 0};
}

}  // namespace snare::test
