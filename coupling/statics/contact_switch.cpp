#include "coupling/statics/contact_switch.hpp"

#include "coupling/statics/contact_forces.hpp"
#include "coupling/statics/contact_wrap.hpp"

#include <cmath>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;

/// Where a function that was f0 at the start of the step and is f1 at its end crosses zero.
double crossing(double f0, double f1) {
  return f0 / (f0 - f1);
}

// Sticking or sliding of a pin that is pressed. Returns true when the status changed.
bool settle_friction(SlidingContact& contact, const VertexTangent& v, const Vector2d& force,
                     double coordinate, const ContactTolerance& tolerance, ContactMemory& memory) {
  if (contact.friction == 0.0 || contact.holds_material) return false;
  const PinForce now = resolve(force, v.t, contact.side);
  if (contact.status == ContactStatus::stick) {
    const double excess = std::abs(now.tangential) - contact.friction * now.normal;
    if (excess <= tolerance.force) return false;
    contact.status = ContactStatus::slip;
    contact.slip_sign = now.tangential > 0.0 ? 1.0 : -1.0;
    const PinForce last = resolve(contact.last_force, contact.last_tangent, contact.side);
    const double before = contact.slip_sign * last.tangential - contact.friction * last.normal;
    if (before < -tolerance.force) memory.at_fraction(crossing(before, excess));
    return true;
  }
  // Sliding ends where the wire would slide back.
  const double slip = slip_of(contact, v, coordinate) * contact.slip_sign;
  if (slip >= -tolerance.slip) return false;
  contact.status = ContactStatus::stick;
  return true;
}

bool settle_mount(std::size_t which, PushSystem& system, const numerics::PathPoint& point,
                  const ContactTolerance& tolerance, ContactMemory& memory) {
  SlippingMount& mount = system.mounts[which];
  if (mount.follows) return false;
  const double drive = system.mount_drive(which, point);
  if (!mount.slips) {
    if (std::abs(drive) <= mount.limit + tolerance.force) return false;
    mount.slips = true;
    mount.slip_sign = drive > 0.0 ? 1.0 : -1.0;
    const double before = mount.slip_sign * mount.last_drive - mount.limit;
    if (before < -tolerance.force) memory.at_fraction(crossing(before, std::abs(drive) - mount.limit));
    return true;
  }
  // A pull (drive > 0) brings wire in.
  if (mount.moved(system.mount_place(which, point)) * mount.slip_sign >= -tolerance.slip) return false;
  mount.slips = false;
  return true;
}

// An open pusher that has come into the wire presses it from now on.
bool close_pusher(PushSystem& system, numerics::PathPoint& point, const ContactTolerance& tolerance,
                  ContactMemory& memory) {
  SlidingContact& pusher = system.sliding[0];
  const SlidingRows rows = system.pusher_rows();
  const double gap = point.border[rows.gap];
  if (gap >= -tolerance.gap) return false;
  if (pusher.last_gap > tolerance.gap) memory.at_fraction(crossing(pusher.last_gap, gap));
  pusher.status = pusher.friction > 0.0 ? ContactStatus::stick : ContactStatus::slip;
  pusher.last_coordinate = point.border[rows.coordinate];
  pusher.last_tangent = system.tangent_at(pusher, system.state(point)).t;
  point.border[rows.gap] = 0.0;
  return true;
}

// The pusher's force pulls: it leaves the wire, or the wire slides over it.
void release_pusher(PushSystem& system, numerics::PathPoint& point, const PinForce& now,
                    const ContactTolerance& tolerance, ContactMemory& memory) {
  SlidingContact& pusher = system.sliding[0];
  if (pusher.status == ContactStatus::stick && pusher.last_force.norm() <= tolerance.force) {
    // The first touch of a steep wire: sticking would pull. It slides, or leaves.
    pusher.status = ContactStatus::slip;
    pusher.slip_sign = now.tangential > 0.0 ? 1.0 : -1.0;
    return;
  }
  const PinForce last = resolve(pusher.last_force, pusher.last_tangent, pusher.side);
  if (last.normal > tolerance.force) memory.at_fraction(crossing(last.normal, now.normal));
  pusher.status = ContactStatus::open;
  point.border.segment<2>(system.pusher_rows().force).setZero();
}

// One condition of contact after the other; the first that is violated changes its state.
bool change_state(PushSystem& system, numerics::PathPoint& point, ContactMemory& memory) {
  const ContactTolerance tolerance = contact_tolerance(system);
  for (std::size_t k = 0; k < system.mounts.size(); ++k) {
    if (settle_mount(k, system, point, tolerance, memory)) return true;
  }
  const SlidingContact& pusher = system.sliding[0];
  if (pusher.status == ContactStatus::wrapped) return settle_wrap(system, point, tolerance);
  if (pusher.status == ContactStatus::open) return close_pusher(system, point, tolerance, memory);

  const wire::PlanarState state = system.state(point);
  // Supports first: as long as one holds a wire that slides over it, the pusher's force is not that of the
  // equilibrium.
  for (std::size_t k = system.sliding.size(); k-- > 0;) {
    SlidingContact& contact = system.sliding[k];
    const SlidingRows rows = system.sliding_rows(k);
    const VertexTangent v = system.tangent_at(contact, state);
    const Vector2d force = point.border.segment<2>(rows.force);
    const PinForce now = resolve(force, v.t, contact.side);
    if (k == 0 && now.normal < -tolerance.force) {
      release_pusher(system, point, now, tolerance, memory);
      return true;
    }
    if (settle_friction(contact, v, force, point.border[rows.coordinate], tolerance, memory)) return true;
  }
  return begin_wrap(system, point, tolerance);
}

}  // namespace

std::vector<PushEvent::Kind> contact_events(const ContactStates& before, const ContactStates& after) {
  using Kind = PushEvent::Kind;
  std::vector<Kind> events;
  const ContactStatus was = before.sliding[0].status;
  const ContactStatus is = after.sliding[0].status;
  const bool frictional = after.sliding[0].friction > 0.0;
  if (was != is) {
    if (is == ContactStatus::open) events.push_back(Kind::lift_off);
    if (was == ContactStatus::open) events.push_back(Kind::touch);
    if (is == ContactStatus::wrapped) events.push_back(Kind::wrap_begins);
    if (was == ContactStatus::wrapped) events.push_back(Kind::wrap_ends);
    if (frictional && was == ContactStatus::stick && is == ContactStatus::slip)
      events.push_back(Kind::slip_begins);
    if (frictional && was == ContactStatus::slip && is == ContactStatus::stick)
      events.push_back(Kind::slip_ends);
  } else if (frictional && is == ContactStatus::slip &&
             before.sliding[0].slip_sign != after.sliding[0].slip_sign) {
    events.push_back(Kind::slip_ends);
    events.push_back(Kind::slip_begins);
  }
  for (std::size_t k = 0; k < after.mounts.size() && k < before.mounts.size(); ++k) {
    if (after.mounts[k].slips == before.mounts[k].slips) continue;
    events.push_back(after.mounts[k].slips ? Kind::mount_slips : Kind::mount_holds);
  }
  return events;
}

bool settle_contact(PushSystem& system, numerics::PathPoint& point, ContactMemory& memory) {
  const bool changed = change_state(system, point, memory);
  if (changed) memory.change();
  return changed;
}

void remember_contact(PushSystem& system, const numerics::PathPoint& point) {
  const wire::PlanarState state = system.state(point);
  for (std::size_t k = 0; k < system.sliding.size(); ++k) {
    SlidingContact& contact = system.sliding[k];
    const SlidingRows rows = system.sliding_rows(k);
    const VertexTangent tangent = system.tangent_at(contact, state);
    contact.slip_work =
        contact.slip_work.after(slip_of(contact, tangent, point.border[rows.coordinate]), point.parameter,
                                std::abs(contact.last_force.dot(contact.last_tangent)));
    contact.last_coordinate = point.border[rows.coordinate];
    contact.last_tangent = tangent.t;
    contact.last_force = point.border.segment<2>(rows.force);
    contact.last_gap = point.border[rows.gap];
  }
  const Vector2d centre = system.pusher_centre(point);
  for (std::size_t k = 0; k < system.wrapped.size(); ++k) {
    WrappedContact& contact = system.wrapped[k];
    const Eigen::Vector2d radial = (wire::vertex(state, contact.node) - centre).normalized();
    contact.slip_work = contact.slip_work.after(
        system.sliding[0].radius * angle_between(contact.last_radial, radial), point.parameter,
        std::abs(contact.last_force.dot(left_of(contact.last_radial))));
    contact.last_radial = radial;
    contact.last_force = point.border.segment<2>(system.wrapped_rows(k).force);
  }
  for (std::size_t k = 0; k < system.mounts.size(); ++k) {
    system.mounts[k].last = system.mount_place(k, point);
    system.mounts[k].last_drive = system.mount_drive(k, point);
  }
  if (!system.rod().has_memory()) return;
  system.sections = system.rod().remembered(state);
  system.follow_drift(state.controls, point.parameter);
}

}  // namespace snare::coupling
