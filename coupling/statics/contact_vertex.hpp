#pragma once

#include "coupling/statics/push_system.hpp"

namespace snare::coupling {

/// Makes the material point at `coordinate` [m] the contact vertex: the shape stays, the vertices of the mesh
/// move along it (theory W.10), to positions by the cubic through the four nearest old ones.
void move_contact_vertex(PushSystem& system, numerics::PathPoint& point, double coordinate);

/// Puts the contact vertex at the point of the wire nearest to the pusher and opens the contact, or, where
/// the wire lies inside the pusher, presses it out. False when there is no such equilibrium.
[[nodiscard]] bool reseat_contact(PushSystem& system, numerics::PathPoint& point,
                                  numerics::PathWorkspace& workspace);

}  // namespace snare::coupling
