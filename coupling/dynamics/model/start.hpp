#pragma once

#include "wire/motion/rod_in_motion.hpp"

#include <Eigen/Core>

namespace snare::coupling {

// Shapes of wires at the start of a motion.

/// Vertices evenly spread between the mounts' positions (or from `from` to `to`), (3, vertices) [m].
[[nodiscard]] Eigen::Matrix3Xd straight_wire(const wire::RodInMotion& rod, const Eigen::Vector3d& from,
                                             const Eigen::Vector3d& to);

/// The wire at rest between its mounts, buckled to +y in its first mode where it is longer than their
/// distance. (3, vertices) [m]. Throws InputError when no equilibrium is found.
[[nodiscard]] Eigen::Matrix3Xd resting_wire(const wire::RodInMotion& rod);

}  // namespace snare::coupling
