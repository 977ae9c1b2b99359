#pragma once

#include "coupling/dynamics/model/model.hpp"

#include <optional>

namespace snare::coupling {

/// Across which axis of the world, 0 to 2, a motion has a plane in which it stays when its wires do, since
/// all else in it is its own mirror image there.                                             theory.md (M.36)
///
/// Places and shapes have to be so to round-off (1e-12 [m] or [-]), velocities and forces exactly. None where
/// there is anything whose mirror image is not known: arms, robots, courses, other contacts than of shapes
/// with wires. The wires: RodPart::plane_across.
[[nodiscard]] std::optional<int> symmetry_normal(const Motion& motion);

}  // namespace snare::coupling
