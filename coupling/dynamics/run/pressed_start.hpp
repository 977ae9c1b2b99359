#pragma once

#include "coupling/contact/foundation.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <Eigen/Core>

namespace snare::coupling {

/// A hollow cylinder in which a loose wire lies, in the wire's own frame: chord along x from the origin,
/// bulge to y, axis along z.
struct RoundWall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  double inner_radius = 0.0;                         ///< [m], > 0
  double outer_radius = 0.0;                         ///< [m], > inner_radius
  double length = 0.0;                               ///< [m], > 0
  ElasticFoundation foundation;                      ///< between wire and wall
};

/// A wire between pins at rest against a wall that it would bow beyond, in its plane: (3, vertices) [m]. Of a
/// wire that clears the wall it is resting_wire. wire_radius [m], > 0.                       theory.md (M.33)
///
/// The wire begins as the arc of its length between its mounts and follows what bends it and what presses on
/// it, damped and without inertia, until it rests. Throws base::InputError where that arc does not fit into
/// the wall or no rest is found.
[[nodiscard]] Eigen::Matrix3Xd pressed_wire(const wire::RodInMotion& rod, double wire_radius,
                                            const RoundWall& wall);

}  // namespace snare::coupling
