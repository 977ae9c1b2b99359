#pragma once

namespace snare::wire {

class PlanarRod;
struct PlanarState;
struct RodAssembly;

/// Of PlanarRod::assemble the energy [J] and its first derivatives alone, by q [N] and by the controls [N]: a
/// third of the work. The rest of `out` stays as it was.
void assemble_gradient(const PlanarRod& rod, const PlanarState& state, RodAssembly& out);

}  // namespace snare::wire
