#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/result.hpp"
#include "scenario/placement.hpp"

namespace snare::scenario {

/// Where a frame is in the samples of a motion.
class FrameTrack {
 public:
  /// The motion stays the caller's and outlives it.
  FrameTrack(const coupling::Motion& motion, const PlacedFrame& frame);

  /// Pose in the world, angular velocity and velocity of the origin, in the axes of the world.
  struct State {
    multibody::Pose X_WF;
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] State at(const coupling::MotionSample& sample) const;

 private:
  const coupling::Motion& motion_;
  coupling::MotionCarrier carrier_;
  multibody::Pose X_CF_;  // in the carrier
};

}  // namespace snare::scenario
