#pragma once

#include "wire/planar_rod.hpp"
#include "wire/spatial_rod.hpp"

#include <Eigen/Core>

#include <array>

namespace snare::wire {

/// Unit tangents [-] of the centreline at the left and the right end of a rod, in the sense of increasing arc
/// length, of second order in the edge. They differ from the mount's direction at pins and where a clamp
/// gives in rotation.
///                                                                                           theory.md (W.36)
[[nodiscard]] std::array<Eigen::Vector2d, 2> end_tangents(const PlanarRod& rod, const PlanarState& state);
/// The same in space [-].
[[nodiscard]] std::array<Eigen::Vector3d, 2> end_tangents(const SpatialRod& rod, const SpatialState& state);

}  // namespace snare::wire
