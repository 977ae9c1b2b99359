#pragma once

#include "numerics/report.hpp"
#include "wire/motion/rod_part.hpp"

#include <Eigen/Core>

namespace snare::wire {

/// A wire at rest between mounts that stand still.
struct RodRest {
  Eigen::Matrix3Xd positions;  ///< of the vertices [m]
  RodPart::Energies energies;  ///< and the forces and couples of the mounts
  numerics::SolveReport report;
};

/// The equilibrium of a wire in motion near `start` (3, vertices) [m], stable or not: Newton's method on the
/// residual of RodPart itself without velocities, so that a motion begins where the same discrete rod rests.
/// Strands hold nothing.
[[nodiscard]] RodRest find_rest(const RodInMotion& rod, const Eigen::Matrix3Xd& start);

}  // namespace snare::wire
