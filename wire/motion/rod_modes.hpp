#pragma once

#include "wire/motion/rod_in_motion.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::wire {

/// One mode of small vibration about a rest, undamped: K phi = w^2 M phi with the twist quasi-static.
///                                                                                            theory.md (M.4)
struct RodMode {
  double natural = 0.0;  ///< w [rad/s], > 0
  /// Shares of phi^T K phi that bend and that stretch material, r_b and r_a: what Kelvin-Voigt times act on.
  /// The rest, of tension and prestress, does not dissipate; it is negative in a buckled wire, and the shares
  /// then sum to more than 1.
  double bending_share = 0.0, axial_share = 0.0;
  Eigen::Matrix3Xd shape;  ///< of the vertices, largest component 1
};

/// The `count` modes of lowest frequency (fewer where the rod has fewer), free swings without stiffness left
/// out. rest: vertices in equilibrium, in a plane [m], as many as the rod has. Strands are taken for
/// slipping: EI alone. A dense eigenproblem of three unknowns a vertex: some 0.1 s with 60 elements.
[[nodiscard]] std::vector<RodMode> rod_modes(const RodInMotion& rod, const Eigen::Matrix3Xd& rest, int count);

}  // namespace snare::wire
