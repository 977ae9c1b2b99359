#pragma once

#include "coupling/statics/push_curve.hpp"
#include "coupling/statics/push_system.hpp"

#include <array>

namespace snare::coupling {

/// A pin's force on the wire.
struct PinForce {
  double normal = 0.0;      ///< along the wire's normal, away from the pin [N]; >= 0 presses
  double tangential = 0.0;  ///< along the wire's tangent [N]
};
/// A force on the wire [N] by its components. tangent: of the wire, unit vector; side: of SlidingContact.
[[nodiscard]] PinForce resolve(const Eigen::Vector2d& force, const Eigen::Vector2d& tangent, double side);

/// Slip of the material over the pin since the last accepted state: dS + side R d angle [m].  theory.md (C.5)
/// coordinate: S now.
[[nodiscard]] double slip_of(const SlidingContact& contact, const VertexTangent& now, double coordinate);

/// Friction work between the remembered state and `now` [J], >= 0 (trapezoidal in the force). states_before:
/// of the contacts at the remembered state: one that has opened since slid until then.
[[nodiscard]] double friction_work(const PushSystem& system, const ContactStates& states_before,
                                   const numerics::PathPoint& before, const numerics::PathPoint& now);

/// Sums of the pusher's normal forces and of its friction forces (along the wire's tangent) [N].
struct PusherForces {
  double normal = 0.0;
  double friction = 0.0;
  bool slipping = false;  ///< every point of contact slides (false without friction)
};
[[nodiscard]] PusherForces pusher_forces(const PushSystem& system, const wire::PlanarState& state,
                                         const numerics::PathPoint& at);

/// Forces of the left and the right mount, or support, on the wire [N], at the point that the system was
/// assembled at last.
[[nodiscard]] std::array<Eigen::Vector2d, 2> mount_forces(const PushSystem& system,
                                                          const numerics::PathPoint& at);

/// Puts the mounts' reactions, the axial forces at the ends and the largest tension into a point of the
/// curve.
///                                                                                           theory.md (W.36)
/// reactions: of the left and the right mount on the wire [N]; tangents: of the wire at its ends, unit
/// vectors;
/// tensions: of the edges [N].
void put_end_forces(const std::array<Eigen::Vector3d, 2>& reactions,
                    const std::array<Eigen::Vector3d, 2>& tangents, const Eigen::VectorXd& tensions,
                    PushPoint& point);

/// How much of the wire touches the pusher; a point contact has length 0.
struct ContactExtent {
  double coordinate = 0.0;  ///< material coordinate of the middle of the contact [m]
  double length = 0.0;      ///< of wire between the outermost points of contact [m]
};
[[nodiscard]] ContactExtent contact_extent(const PushSystem& system, const wire::PlanarState& state);

}  // namespace snare::coupling
