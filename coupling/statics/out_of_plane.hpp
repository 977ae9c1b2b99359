#pragma once

#include "wire/planar_rod.hpp"
#include "wire/spatial_rod.hpp"

namespace snare::coupling {

/// The rod of a planar push in space: same mesh, mounts, stiffnesses; isotropic in bending.
/// Its weight acts in the plane. torsional_stiffness: GJ [N m^2], > 0.
[[nodiscard]] wire::SpatialRod spatial_rod(const wire::PlanarRod& planar, double torsional_stiffness);

/// Negative eigenvalues of the rod's tangent stiffness out of the plane at a planar state: modes in which the
/// wire leaves the plane while the pusher, free along its axis, holds its point of contact in the plane. The
/// swing of an unloaded wire about its chord is neutral and not counted. torsional_stiffness: GJ [N m^2], >
/// 0.
[[nodiscard]] int out_of_plane_modes(const wire::PlanarRod& rod, const wire::PlanarState& state,
                                     double torsional_stiffness);

}  // namespace snare::coupling
