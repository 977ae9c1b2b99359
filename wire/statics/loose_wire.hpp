#pragma once

#include "wire/planar_rod.hpp"
#include "wire/spatial_rod.hpp"
#include "wire/statics/equilibrium.hpp"

namespace snare::wire {

/// The loose wire between its mounts before anything touches it: the wire starts straight, its ends approach
/// to the span, it buckles into the asked mode.                                     theory.md (W.12)
///
/// The start of the iteration is the inextensible shape of that mode with the asked shortening, its turning
/// angle A f(S) with A from the closed form of the shortening; the shape returned is the rod's own
/// equilibrium.
/// mode: 1 to 4. A wire shorter than the span, or with less slack than it needs to buckle, stays straight.
struct LooseWire {
  PlanarState state;
  EquilibriumReport report;
};
[[nodiscard]] LooseWire find_loose_wire(const PlanarRod& rod, const Controls& controls, int mode);

/// Compression at which the straight wire buckles between its mounts in the given mode [N]:
/// clamped (2 pi)^2, 80.7629, (4 pi)^2, 238.7 times EI/L^2; pinned (n pi)^2.
[[nodiscard]] double buckling_load(const PlanarRod& rod, double length, int mode);

/// A planar state in space: turned about the chord's direction x by `plane` [rad], without twist. `rod` has
/// the mesh of the planar one and mounts on the x axis.
[[nodiscard]] SpatialState in_space(const SpatialRod& rod, const PlanarState& planar, double plane = 0.0);

/// The loose wire in space, buckled in the given mode in the plane at angle `plane` about the chord. `planar`
/// is the same wire in its plane. Weight and natural curvature then shape it further. plane [rad].
struct LooseSpatialWire {
  SpatialState state;
  EquilibriumReport report;
};
[[nodiscard]] LooseSpatialWire find_loose_wire(const SpatialRod& rod, const PlanarRod& planar,
                                               const Controls& controls, int mode, double plane);

}  // namespace snare::wire
