#pragma once

#include "wire/planar_rod.hpp"
#include "wire/specification.hpp"

#include <Eigen/Core>

namespace snare::wire {

/// Constants of the planar rod of a declared wire between its mounts, at the origin and at (span, 0) [m];
/// strands and yielding become sliders (W.13). gravity: in the plane [m/s^2].
[[nodiscard]] PlanarRodProperties planar_rod_properties(const WireSpecification& wire,
                                                        const MountSpecification& mount,
                                                        const Eigen::Vector2d& gravity);

}  // namespace snare::wire
