#pragma once

#include "multibody/urdf.hpp"

#include <array>
#include <cstddef>
#include <string>

namespace snare::multibody {

/// A link that bends: two hinges across it where its joint carries it.                       theory.md (A.19)
struct Flexure {
  std::string link, root;             ///< names of the link, and of the part of it that its joint carries
  std::array<std::string, 2> hinges;  ///< names of their joints
  double stiffness = 0.0;             ///< of each [N m/rad], > 0
  double damping = 0.0;               ///< [N m s/rad], >= 0
};

/// Whether a link stands on a joint that turns or slides, and has a mass and a length.
[[nodiscard]] bool can_bend(const RobotDescription& robot, std::size_t link);

/// Cuts a link that can bend into what its joint carries, a tenth of its inertia, and the rest behind two
/// hinges across its length, which goes to the next joint that is elsewhere, else to its centre of mass.
/// stiffness [N m/rad] > 0, damping [N m s/rad] >= 0, of each hinge. The link itself comes two places later
/// in the lists.
[[nodiscard]] Flexure bend_link(RobotDescription& robot, std::size_t link, double stiffness, double damping);

}  // namespace snare::multibody
