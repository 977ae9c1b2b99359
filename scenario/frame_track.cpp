#include "scenario/frame_track.hpp"

#include "base/index.hpp"
#include "multibody/kinematics.hpp"

namespace snare::scenario {

using coupling::MotionCarrier;
using multibody::Pose;

FrameTrack::FrameTrack(const coupling::Motion& motion, const PlacedFrame& frame)
    : motion_(motion), carrier_(frame.carrier), X_CF_(frame.X_WF) {
  if (carrier_.kind == MotionCarrier::Kind::body) {
    X_CF_ = pose_of(motion.bodies[base::at(carrier_.index)].start).inverse() * frame.X_WF;
  } else if (carrier_.kind == MotionCarrier::Kind::arm) {
    const coupling::MotionArm& arm = motion.arms[base::at(carrier_.index)];
    multibody::Kinematics kinematics(arm.arm.tree);
    multibody::place(arm.arm.tree, arm.start.q, kinematics);
    X_CF_ = multibody::frame_pose(arm.arm.tree, kinematics, carrier_.frame).inverse() * frame.X_WF;
  }
}

FrameTrack::State FrameTrack::at(const coupling::MotionSample& sample) const {
  State s;
  if (carrier_.kind == MotionCarrier::Kind::body) {
    const multibody::RigidBodyState& body = sample.bodies[base::at(carrier_.index)];
    const Pose X_WB = pose_of(body);
    s.X_WF = X_WB * X_CF_;
    s.angular = X_WB.R * body.spin;
    s.linear = body.velocity + s.angular.cross(X_WB.R * X_CF_.p);
  } else if (carrier_.kind == MotionCarrier::Kind::arm) {
    const multibody::Tree& tree = motion_.arms[base::at(carrier_.index)].arm.tree;
    const multibody::ArmState& arm = sample.arms[base::at(carrier_.index)].state;
    multibody::Kinematics kinematics(tree);
    multibody::place(tree, arm.q, kinematics);
    multibody::set_moving(tree, arm.v, kinematics);
    const multibody::FrameMotion motion = multibody::frame_motion(tree, kinematics, carrier_.frame);
    const Pose X_WC = multibody::frame_pose(tree, kinematics, carrier_.frame);
    s.X_WF = X_WC * X_CF_;
    s.angular = motion.angular;
    s.linear = motion.linear + motion.angular.cross(X_WC.R * X_CF_.p);
  } else {
    s.X_WF = X_CF_;
  }
  return s;
}

}  // namespace snare::scenario
