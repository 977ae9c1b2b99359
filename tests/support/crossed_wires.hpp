#pragma once

#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/soft_wire.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <string>

namespace snare::test {

/// The soft wire between two other points, stretched by `strain` beyond its length.
[[nodiscard]] inline coupling::MotionWire wire_between(
    const std::string& name, const Eigen::Vector3d& from, const Eigen::Vector3d& to, int elements,
    double strain = 0.0, wire::SpatialEnd::Kind ends = wire::SpatialEnd::Kind::clamp) {
  coupling::MotionWire wire;
  wire.name = name;
  wire.rod = soft_wire(elements);
  const Eigen::Vector3d along = (to - from).normalized();
  for (wire::SpatialEnd* end : {&wire.rod.properties.left, &wire.rod.properties.right}) {
    end->kind = ends;
    end->direction = along;
    end->director = along.unitOrthogonal();
  }
  wire.rod.properties.left.position = from;
  wire.rod.properties.right.position = to;
  wire.rod.length = (to - from).norm() / (1.0 + strain);
  wire.positions = coupling::straight_wire(wire.rod, from, to);
  return wire;
}

/// Two wires of 0.2 m and 1 mm radius that cross at their middles under an angle [rad], the second below the
/// first by `gap`, parallel to the plane y = 0; moved along themselves by a part of an element.
[[nodiscard]] inline coupling::Motion crossed_wires(double angle, double gap, int elements,
                                                    double strain = 0.0) {
  constexpr double radius = 1e-3, half = 0.1, aside = 0.0012;
  coupling::Motion motion;
  const Eigen::Vector3d a(1.0, 0.0, 0.0), b(std::cos(angle), 0.0, std::sin(angle));
  const Eigen::Vector3d below(0.0, -2.0 * radius - gap, 0.0);
  motion.wires.push_back(wire_between("upper", (aside - half) * a, (aside + half) * a, elements, strain));
  motion.wires.push_back(wire_between("lower", below + (0.4 * aside - half) * b,
                                      below + (0.4 * aside + half) * b, elements, strain));
  coupling::WirePair pair;
  pair.radii = {radius, radius};
  motion.wire_pairs.push_back(pair);
  return motion;
}

}  // namespace snare::test
