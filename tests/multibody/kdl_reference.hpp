#pragma once

#include "tests/multibody/random_tree.hpp"

#include <kdl/jntarray.hpp>
#include <kdl/jntarrayvel.hpp>
#include <kdl/tree.hpp>

namespace snare::test {

inline KDL::Vector to_kdl(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
inline KDL::Rotation to_kdl(const Eigen::Matrix3d& R) {
  return {R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)};
}

/// One body as KDL's segment; KDL knows no free joint.
inline KDL::Segment kdl_segment(const PlainBody& b, std::size_t i) {
  const KDL::Frame X(to_kdl(b.R), to_kdl(b.p));
  const KDL::Vector axis = to_kdl(Eigen::Vector3d(b.R * b.axis));
  const std::string name = "joint" + std::to_string(i);
  const KDL::Joint joint =
      b.joint == PlainBody::Joint::revolute    ? KDL::Joint(name, X.p, axis, KDL::Joint::RotAxis)
      : b.joint == PlainBody::Joint::prismatic ? KDL::Joint(name, X.p, axis, KDL::Joint::TransAxis)
                                               : KDL::Joint(name, KDL::Joint::Fixed);
  const Eigen::Matrix3d& I = b.inertia;
  return KDL::Segment(
      body_name(i), joint, X,
      KDL::RigidBodyInertia(b.mass, to_kdl(b.centre),
                            KDL::RotationalInertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2))));
}

inline KDL::Tree kdl_tree(const PlainTree& plain) {
  KDL::Tree tree("world");
  for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
    const int parent = plain.bodies[i].parent;
    tree.addSegment(kdl_segment(plain.bodies[i], i),
                    parent < 0 ? "world" : body_name(static_cast<std::size_t>(parent)));
  }
  return tree;
}

inline KDL::JntArray to_kdl(const Eigen::VectorXd& v) {
  KDL::JntArray a(static_cast<unsigned>(v.size()));
  a.data = v;
  return a;
}

}  // namespace snare::test
