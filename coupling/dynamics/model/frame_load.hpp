#pragma once

#include "coupling/dynamics/model/arm.hpp"
#include "multibody/spatial.hpp"

#include <Eigen/Core>

#include <limits>
#include <string>
#include <vector>

namespace snare::coupling {

/// A force and a moment on a frame over time: a thruster, a pull.                            theory.md (M.29)
///
/// Straight between its times, or with half a sine of what stands at the first of two; nothing before the
/// first and after the last; a jump is two equal times.
struct FrameLoad {
  std::string name = "load";
  MotionCarrier carrier;
  multibody::Pose X_WF;       ///< of the frame at the start: the force acts at its origin
  bool in_frame = true;       ///< along the axes of the frame; false: of the world
  bool half_sines = false;    ///< between its times
  std::vector<double> times;  ///< [s], ascending
  Eigen::Matrix3Xd forces;    ///< at the times [N]
  Eigen::Matrix3Xd moments;   ///< at the times [N m]
};

}  // namespace snare::coupling
