#pragma once

#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"

#include <Eigen/Core>

#include <memory>

namespace snare::test {

/// A soft, damped wire of 0.2 m, straight between clamps: forces of newtons at motions of millimetres.
[[nodiscard]] inline wire::RodInMotion soft_wire(int elements) {
  wire::RodInMotion rod;
  rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = 1e-3;
  rod.properties.torsional_stiffness = 8e-4;
  rod.properties.axial_stiffness = 1e3;
  rod.properties.right.position = {0.2, 0.0, 0.0};
  rod.properties.left.kind = rod.properties.right.kind = wire::SpatialEnd::Kind::clamp;
  rod.mass_per_length = 0.01;
  rod.length = 0.2;
  rod.elements = elements;
  rod.damping.bending_time = 2e-4;
  rod.damping.axial_time = 1e-4;
  return rod;
}

/// Tolerances that follow the vibration of such a wire, for balances of small bodies.
[[nodiscard]] inline coupling::MotionOptions fine_tolerances() {
  coupling::MotionOptions options;
  options.relative_tolerance = 1e-7;
  options.position_tolerance = 1e-8;
  options.velocity_tolerance = 1e-4;
  options.body_position_tolerance = options.angle_tolerance = 1e-9;
  options.newton_share = 0.003;
  return options;
}

/// The wire and a body of `mass` that carries a shape at its centre and moves along y.
[[nodiscard]] inline coupling::Motion body_below(const wire::RodInMotion& rod,
                                                 std::shared_ptr<const coupling::ContactShape> shape,
                                                 const Eigen::Vector3d& place, double speed, double mass) {
  coupling::Motion motion;
  motion.wires.push_back(
      {"wire", rod, coupling::straight_wire(rod, Eigen::Vector3d::Zero(), {0.2, 0.0, 0.0}), {}});
  coupling::MotionBody body;
  body.properties.mass = mass;
  body.properties.inertia = 4e-4 * mass * Eigen::Matrix3d::Identity();
  body.start.position = place;
  body.start.velocity = {0.0, speed, 0.0};
  motion.bodies.push_back(body);
  coupling::MotionContact contact;
  contact.shape = std::move(shape);
  contact.wire_radius = 0.001;
  motion.contacts.push_back(contact);
  return motion;
}

}  // namespace snare::test
