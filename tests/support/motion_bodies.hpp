#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/options.hpp"
#include "multibody/arm/elastic_arm.hpp"

namespace snare::test {

/// A body at rest in the origin, with principal moments of inertia [kg m^2].
[[nodiscard]] inline coupling::MotionBody block(const char* name, double mass,
                                                const Eigen::Vector3d& moments) {
  coupling::MotionBody body;
  body.name = name;
  body.properties.mass = mass;
  body.properties.inertia = moments.asDiagonal();
  return body;
}

[[nodiscard]] constexpr coupling::MotionCarrier body_of(int index) {
  return {coupling::MotionCarrier::Kind::body, index, 0};
}

/// An arm of one link on an elastic joint about `axis`.
[[nodiscard]] inline multibody::ElasticArm one_joint(const char* link, const Eigen::Vector3d& axis) {
  multibody::ElasticArm model;
  model.tree.add_moving(
      0, link, multibody::JointKind::revolute, axis, {},
      multibody::SpatialInertia::about_centre(4.0, {0.2, 0.1, 0.0}, 0.2 * Eigen::Matrix3d::Identity()));
  multibody::ElasticJoint joint;
  joint.motor_inertia = 1.0;
  joint.spring = multibody::DeflectionLaw::linear(20.0, 1.0);
  model.joints.push_back(joint);
  return model;
}

/// For comparison with closed forms [s].
[[nodiscard]] inline coupling::MotionOptions fine(double duration, double output_interval) {
  coupling::MotionOptions o;
  o.duration = duration;
  o.output_interval = output_interval;
  o.relative_tolerance = 1e-9;
  o.body_position_tolerance = o.angle_tolerance = 1e-11;
  o.body_velocity_tolerance = o.spin_tolerance = 1e-9;
  o.max_order = 5;
  return o;
}

}  // namespace snare::test
