#include "coupling/statics/out_of_plane.hpp"

#include "numerics/band_matrix.hpp"
#include "wire/statics/loose_wire.hpp"

#include <algorithm>

namespace snare::coupling {

namespace {

wire::SpatialEnd spatial_end(const wire::PlanarEnd& end) {
  wire::SpatialEnd result;
  // A pin of the plane holds the twist: nothing in the plane would.
  result.kind = end.kind == wire::PlanarEnd::Kind::clamp ? wire::SpatialEnd::Kind::clamp
                                                         : wire::SpatialEnd::Kind::twisting_pin;
  result.position = {end.position.x(), end.position.y(), 0.0};
  result.rotational_stiffness = end.rotational_stiffness;
  result.translational_stiffness = end.translational_stiffness;
  return result;
}

}  // namespace

wire::SpatialRod spatial_rod(const wire::PlanarRod& planar, double torsional_stiffness) {
  const wire::PlanarRodProperties& p = planar.properties();
  wire::SpatialRodProperties properties;
  properties.bending_stiffness = p.bending_stiffness;
  properties.second_bending_stiffness = p.bending_stiffness;
  properties.torsional_stiffness = torsional_stiffness;
  properties.axial_stiffness = p.axial_stiffness;
  // With the clamps' director along y and no twist, kappa_1 is the curvature in the plane, up to its sign.
  properties.natural_curvature = {p.natural_curvature, 0.0};
  properties.weight = {p.weight.x(), p.weight.y(), 0.0};
  properties.left = spatial_end(p.left);
  properties.right = spatial_end(p.right);
  return {planar.mesh(), properties};
}

int out_of_plane_modes(const wire::PlanarRod& planar, const wire::PlanarState& state,
                       double torsional_stiffness) {
  const wire::SpatialRod rod = spatial_rod(planar, torsional_stiffness);
  const wire::SpatialState s = wire::in_space(rod, state);
  wire::RodAssembly assembly;
  rod.assemble(s, {false, false, false}, assembly);
  rod.hold_mounts(assembly);
  // In a planar state z and theta do not couple with x and y: their block alone.
  constexpr int out = 2;        // of the block (x, y, z, theta) of a vertex: z, theta
  constexpr int bandwidth = 5;  // two vertices on: 2 * 2 + 1
  const int n = out * rod.mesh().vertices();
  const auto in_rod = [](int i) { return wire::SpatialRod::block * (i / out) + 2 + i % out; };
  numerics::SymmetricBandMatrix across(n, bandwidth);
  for (int i = 0; i < n; ++i) {
    const int row = in_rod(i);
    for (int j = std::max(0, i - bandwidth); j <= i; ++j) {
      const int column = in_rod(j);
      if (row - column > wire::SpatialRod::half_bandwidth) continue;
      across.lower(i, j) = assembly.hessian.lower(row, column);
    }
  }
  // The swing about the chord of an unloaded wire is neutral: shift the lateral stiffness by far less than
  // any real mode has.
  const double length = state.controls[2] - state.controls[0];
  const double neutral = 1e-6 * planar.properties().bending_stiffness / (length * length * length);
  for (int i = 0; i < n; i += out) across.lower(i, i) += neutral;
  numerics::BandLdlt factor;
  return factor.factorize(across) ? factor.negative_pivots() : 0;
}

}  // namespace snare::coupling
