#pragma once

#include "tests/multibody/random_tree.hpp"

#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/WeldJoint.hpp>

namespace snare::test {

/// The same tree in DART. Its coordinates are in the order of the bodies, as ours are.
class DartTree {
 public:
  explicit DartTree(const PlainTree& plain) : skeleton_(dart::dynamics::Skeleton::create("tree")) {
    using namespace dart::dynamics;
    for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
      const PlainBody& b = plain.bodies[i];
      BodyNode* parent = b.parent < 0 ? nullptr : bodies_[static_cast<std::size_t>(b.parent)];
      BodyNode::Properties body;
      body.mName = body_name(i);
      body.mInertia = Inertia(b.mass, b.centre, b.inertia);
      Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
      X.linear() = b.R;
      X.translation() = b.p;
      const auto common = [&](Joint::Properties& joint) {
        joint.mName = "joint" + std::to_string(i);
        joint.mT_ParentBodyToJoint = X;
      };
      switch (b.joint) {
        case PlainBody::Joint::fixed:
          add<WeldJoint>(parent, common, WeldJoint::Properties(), body);
          break;
        case PlainBody::Joint::free:
          add<FreeJoint>(parent, common, FreeJoint::Properties(), body);
          break;
        case PlainBody::Joint::revolute: {
          RevoluteJoint::Properties joint;
          joint.mAxis = b.axis;
          add<RevoluteJoint>(parent, common, joint, body);
          break;
        }
        case PlainBody::Joint::prismatic: {
          PrismaticJoint::Properties joint;
          joint.mAxis = b.axis;
          add<PrismaticJoint>(parent, common, joint, body);
          break;
        }
      }
    }
    skeleton_->setGravity(plain.gravity);
  }

  /// q and v as ours.
  void set(const multibody::Tree& tree, const multibody::TreeState& state) {
    Eigen::VectorXd positions(tree.velocities());
    for (const multibody::TreeBody& body : tree.bodies()) {
      if (body.joint == multibody::JointKind::free) {
        const multibody::Pose X = multibody::joint_pose(body, state.q);
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = X.R;
        T.translation() = X.p;
        positions.segment<6>(body.v_index) = dart::dynamics::FreeJoint::convertToPositions(T);
      } else {
        positions[body.v_index] = state.q[body.q_index];
      }
    }
    skeleton_->setPositions(positions);
    skeleton_->setVelocities(state.v);
  }

  [[nodiscard]] dart::dynamics::Skeleton& skeleton() { return *skeleton_; }
  [[nodiscard]] dart::dynamics::BodyNode& body(std::size_t i) { return *bodies_[i]; }

  [[nodiscard]] Eigen::VectorXd forward_dynamics(const Eigen::VectorXd& torque) {
    skeleton_->setForces(torque);
    skeleton_->computeForwardDynamics();
    return skeleton_->getAccelerations();
  }

 private:
  template <class Joint, class Common, class Properties>
  void add(dart::dynamics::BodyNode* parent, const Common& common, Properties joint,
           const dart::dynamics::BodyNode::Properties& body) {
    common(joint);
    bodies_.push_back(skeleton_->createJointAndBodyNodePair<Joint>(parent, joint, body).second);
  }

  dart::dynamics::SkeletonPtr skeleton_;
  std::vector<dart::dynamics::BodyNode*> bodies_;
};

}  // namespace snare::test
