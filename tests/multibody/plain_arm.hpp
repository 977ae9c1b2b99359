#pragma once

#include "multibody/arm/arm_run.hpp"
#include "tests/multibody/random_tree.hpp"

#include <string>

namespace snare::test {

/// One link that turns about z with the given moment of inertia, and a motor.
inline multibody::ElasticArm one_joint(double link_inertia, double motor_inertia,
                                       const multibody::DeflectionLaw& law) {
  multibody::ElasticArm arm;
  arm.tree.add_moving(0, "link", multibody::JointKind::revolute, Eigen::Vector3d::UnitZ(), {},
                      multibody::SpatialInertia::about_centre(1.0, Eigen::Vector3d::Zero(),
                                                              link_inertia * Eigen::Matrix3d::Identity()));
  multibody::ElasticJoint joint;
  joint.name = "joint";
  joint.motor_inertia = motor_inertia;
  joint.spring = law;
  arm.joints.push_back(joint);
  return arm;
}

/// Links of 10 kg and 1 m one after another with axes z, y, x, ..., each with a motor; on the world or on a
/// free body of 100 kg.
inline multibody::ElasticArm chain_arm(int links, Base base, double stiffness) {
  multibody::ElasticArm arm;
  int frame = 0;
  if (base == Base::floating) {
    frame = arm.tree.add_moving(
        0, "base", multibody::JointKind::free, Eigen::Vector3d::UnitZ(), {},
        multibody::SpatialInertia::about_centre(100.0, {0.1, 0.0, -0.2}, 40.0 * Eigen::Matrix3d::Identity()));
  }
  for (int i = 0; i < links; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit((i + 2) % 3);
    const multibody::Pose X{Eigen::Matrix3d::Identity(), Eigen::Vector3d(i == 0 ? 0.0 : 1.0, 0.0, 0.0)};
    frame = arm.tree.add_moving(frame, "link" + std::to_string(i), multibody::JointKind::revolute, axis, X,
                                multibody::SpatialInertia::about_centre(
                                    10.0, {0.5, 0.05, 0.0}, Eigen::Vector3d(0.1, 0.9, 0.9).asDiagonal()));
    multibody::ElasticJoint joint;
    joint.name = "joint" + std::to_string(i);
    joint.body = arm.tree.size() - 1;
    joint.motor_inertia = 2.0;
    joint.spring = multibody::DeflectionLaw::linear(stiffness, 0.0);
    arm.joints.push_back(joint);
  }
  return arm;
}

/// Table 2 of Abiko et al. in SI, as the digest converts it.
inline multibody::DeflectionLaw table2(
    double damping_factor, multibody::StiffnessReading reading = multibody::StiffnessReading::continuous) {
  const double degree = EIGEN_PI / 180.0;
  return multibody::DeflectionLaw({{0.0, 12.5 / degree, damping_factor * 48.9 / degree},
                                   {0.04 * degree, 475.0 / degree, damping_factor * 87.3 / degree},
                                   {0.06 * degree, 475.0 / degree, damping_factor * 17.6 / degree}},
                                  reading);
}

}  // namespace snare::test
