#pragma once

#include "base/index.hpp"
#include "multibody/arm/arm_part.hpp"
#include "wire/end.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace snare::coupling {

/// An arm in a motion. Its gravity is that of the motion. Times of its drives, switches and loads count from
/// the start.
struct MotionArm {
  std::string name = "arm";
  multibody::ElasticArm arm;
  multibody::ArmState start;
  std::vector<multibody::Drive> drives;          ///< at the start, one a joint
  std::vector<multibody::DriveSwitch> switches;  ///< in the order of their times
  std::vector<multibody::TimedLoad> loads;

  /// Name of a motor's joint in results: "ARM::JOINT", "SNARE::ring".
  [[nodiscard]] std::string joint_name(int joint) const {
    const std::string& own = arm.joints[base::at(joint)].name;
    const bool with_owner = own.find("::") != std::string::npos;  // of a snare
    return with_owner ? own : name + "::" + own;
  }
};

/// What something is fastened to: the world, a body, or a frame of an arm.
struct MotionCarrier {
  enum class Kind { world, body, arm };
  Kind kind = Kind::world;
  int index = 0;  ///< of the body or the arm
  int frame = 0;  ///< of the arm's tree

  [[nodiscard]] bool operator==(const MotionCarrier&) const = default;
};

/// A free body held by a carrier in the pose in which it starts; it starts with the carrier's motion,
/// whatever its own says. A body is held by one weld, and a body that carries is held, if at all, by an
/// earlier one.
struct MotionWeld {
  std::string name = "weld";
  MotionCarrier carrier;
  int body = 0;  ///< index
};

/// How a mount gives along its axis: a spring that may slip, and a parallel dashpot.         theory.md (M.38)
struct MountGive {
  double stiffness = std::numeric_limits<double>::infinity();  ///< [N/m], > 0; infinite: it does not give
  double damping = 0.0;                                        ///< [N s/m], >= 0
  double slip_force =
      std::numeric_limits<double>::infinity();  ///< of the spring, beyond which it slips [N], > 0

  /// Whether there is a spring, and whether it slips.
  [[nodiscard]] bool gives() const { return !std::isinf(stiffness); }
  [[nodiscard]] bool slips() const { return !std::isinf(slip_force); }
};

/// An end of a wire on a carrier, held where the wire's mount stands at the start; it starts with the
/// carrier's motion. The wire's own end must be rigid along x: clamp, twisting pin or pin.
struct MotionMount {
  std::string name = "mount";
  int wire = 0;  ///< index
  wire::End end = wire::End::left;
  MotionCarrier carrier;
  MountGive give = {};  ///< along the direction of the wire's end, which turns with the carrier
};

}  // namespace snare::coupling
