#include "scenario/housing_wall.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <utility>

namespace snare::scenario {

using Eigen::Matrix3d;
using Eigen::Vector3d;

coupling::MotionWire at_rest_in_wall(DeclaredWire w, PressedRests& known) {
  const Matrix3d R =
      (Matrix3d() << (w.to - w.from) / w.span, w.bulge, (w.to - w.from).cross(w.bulge) / w.span).finished();
  coupling::RoundWall wall = *w.wall;
  wall.centre = R.transpose() * (wall.centre - w.from);
  const wire::RodInMotion& rod = w.wire.rod;
  const double radius = 0.5 * w.specification.diameter;
  const std::string key =
      fmt::format("{:.9g} {:.9g} {} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}", w.span, rod.length,
                  rod.elements, static_cast<int>(rod.formulation), radius, rod.properties.bending_stiffness,
                  rod.properties.axial_stiffness, wall.centre.x(), wall.centre.y(), wall.inner_radius,
                  wall.foundation.modulus);
  auto found = known.find(key);
  if (found == known.end()) {
    wall.centre.z() = 0.0;
    found = known.emplace(key, coupling::pressed_wire(rod, radius, wall)).first;
  }
  return at_rest(std::move(w), &found->second);
}

}  // namespace snare::scenario
