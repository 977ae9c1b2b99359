#pragma once

#include "coupling/statics/push_system.hpp"

namespace snare::coupling {

/// From where on a condition of contact counts as violated.
struct ContactTolerance {
  double force;         ///< against the rod's own forces and the mounts' reactions [N]
  double gap;           ///< against the wire's length [m]
  double slip = 1e-12;  ///< [m]
};
[[nodiscard]] ContactTolerance contact_tolerance(const PushSystem& system);

/// Where the vertices beside that of a pressed pusher are inside it, these and the contact vertex lie on it
/// from now on; the point must be solved again. False: the contact stays at a point.  theory.md (C.7)
[[nodiscard]] bool begin_wrap(PushSystem& system, numerics::PathPoint& point,
                              const ContactTolerance& tolerance);

/// Compares a solution with what its wrapped contacts assume: releases vertices that are pulled, lets them
/// stick or slide, takes in neighbours that are inside the pusher; a last vertex is contact at a point again.
/// True when something changed: the point must be solved again.
[[nodiscard]] bool settle_wrap(PushSystem& system, numerics::PathPoint& point,
                               const ContactTolerance& tolerance);

}  // namespace snare::coupling
