#pragma once

#include "coupling/statics/push_solver.hpp"
#include "coupling/statics/push_system.hpp"

#include <optional>
#include <vector>

namespace snare::coupling {

/// What the contact did within one step: whether its states changed, and how far into the step the first change
/// came.
class ContactMemory {
 public:
  void begin() {
    fraction_.reset();
    changed_ = false;
  }
  void change() { changed_ = true; }
  /// A change at this fraction of the step, in (0, 1).
  void at_fraction(double fraction) {
    if (!fraction_ || fraction < *fraction_) fraction_ = fraction;
  }
  [[nodiscard]] bool changed() const { return changed_; }
  [[nodiscard]] std::optional<double> event_fraction() const { return fraction_; }

 private:
  std::optional<double> fraction_;
  bool changed_ = false;
};

/// What changed between two contact states, in words.
[[nodiscard]] std::vector<PushEvent::Kind> contact_events(const ContactStates& before,
                                                          const ContactStates& after);

/// Compares a solution with what its contact states assume (force >= 0, gap >= 0, |T| <= mu N, slip against the
/// friction, no vertex inside the pusher) and changes the states that are violated.  theory.md (C.9)
/// Returns true when something changed: the point must be solved again.
[[nodiscard]] bool settle_contact(PushSystem& system, numerics::PathPoint& point, ContactMemory& memory);

/// Stores the accepted point as the one from which slip is measured.
void remember_contact(PushSystem& system, const numerics::PathPoint& point);

/// Friction work between the remembered state and `now` [J], >= 0 (trapezoidal in the force).
[[nodiscard]] double friction_work(const PushSystem& system, const numerics::PathPoint& before,
                                   const numerics::PathPoint& now);

/// Sums of the pusher's normal forces and of its friction forces (along the wire's tangent) [N].
struct PusherForces {
  double normal = 0.0;
  double friction = 0.0;
  bool slipping = false;  ///< every point of contact slides (false without friction)
};
[[nodiscard]] PusherForces pusher_forces(const PushSystem& system, const wire::PlanarState& state,
                                         const numerics::PathPoint& at);

struct MountForces {
  Eigen::Vector2d total = Eigen::Vector2d::Zero();  ///< of mounts, supports and weight on the wire [N]
  double tension_left = 0.0;                        ///< [N]
  double tension_right = 0.0;
};
/// At the point that the system was assembled at last.
[[nodiscard]] MountForces mount_forces(const PushSystem& system, const wire::PlanarState& state,
                                       const numerics::PathPoint& at);

struct ContactExtent {
  double coordinate = 0.0;  ///< material coordinate of the middle of the contact [m]
  double length = 0.0;      ///< of wire between the outermost points of contact [m]
};
[[nodiscard]] ContactExtent contact_extent(const PushSystem& system, const wire::PlanarState& state);

/// Puts the contact vertex at the point of the wire nearest to the pusher and opens the contact, or, where the wire
/// lies inside the pusher, presses it out. False when there is no such equilibrium.
[[nodiscard]] bool reseat_contact(PushSystem& system, numerics::PathPoint& point,
                                  numerics::PathWorkspace& workspace);

}  // namespace snare::coupling
