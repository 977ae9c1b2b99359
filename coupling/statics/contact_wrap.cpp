#include "coupling/statics/contact_wrap.hpp"

#include "coupling/statics/contact_vertex.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;

/// The vertices on the pusher in their order along the wire, each with its force.
struct Arc {
  std::vector<WrappedContact> contacts;
  std::vector<Vector2d> forces;

  void add(const WrappedContact& contact, const Vector2d& force) {
    contacts.push_back(contact);
    forces.push_back(force);
  }
};

// Sticks while |f.tau| <= mu f.n, tau being n turned left; slides until it would slide back. True: it has
// changed.
bool settle_friction(WrappedContact& contact, const Vector2d& n, const Vector2d& force, double radius,
                     const ContactTolerance& tolerance) {
  if (contact.friction <= 0.0) return false;
  const double tangential = force.dot(Vector2d(-n.y(), n.x()));
  if (contact.status == ContactStatus::stick) {
    if (std::abs(tangential) <= contact.friction * force.dot(n) + tolerance.force) return false;
    contact.status = ContactStatus::slip;
    contact.slip_sign = tangential > 0.0 ? -1.0 : 1.0;
    return true;
  }
  if (contact.status == ContactStatus::slip &&
      contact.slip_sign * radius * angle_between(contact.last_radial, n) < -tolerance.slip) {
    contact.status = ContactStatus::stick;
    return true;
  }
  return false;
}

// The vertices of the arc and its neighbours that are inside the pusher join it, without force.
Arc with_neighbours(const Arc& kept, const PushSystem& system, const wire::PlanarState& state,
                    const Vector2d& centre, const ContactTolerance& tolerance, bool& changed) {
  Arc complete;
  const int first = std::max(1, kept.contacts.front().node - 1);
  const int last = std::min(system.rod().mesh().edges() - 1, kept.contacts.back().node + 1);
  std::size_t k = 0;
  for (int node = first; node <= last; ++node) {
    if (k < kept.contacts.size() && kept.contacts[k].node == node) {
      complete.add(kept.contacts[k], kept.forces[k]);
      ++k;
      continue;
    }
    const Vector2d arm = wire::vertex(state, node) - centre;
    if (arm.norm() >= system.sliding[0].radius - tolerance.gap) continue;
    WrappedContact joined = complete.contacts.empty() ? kept.contacts.front() : complete.contacts.back();
    joined.node = node;
    joined.last_radial = arm.normalized();
    complete.add(joined, Vector2d::Zero());
    changed = true;
  }
  return complete;
}

// The mounts' unknowns, last in the border, from the old one, where they began at `first`.
void keep_mounts(const Eigen::VectorXd& old, int first, const PushSystem& system,
                 numerics::PathPoint& point) {
  const auto count = static_cast<Eigen::Index>(system.mounts.size());
  point.border.tail(count) = old.segment(first, count);
}

// Replaces the wrapped contacts; the other border unknowns keep their values.
void put(const Arc& arc, PushSystem& system, numerics::PathPoint& point) {
  const Eigen::VectorXd old = point.border;
  const int old_mount = system.mount_row(0);
  const int head = system.wrapped_rows(0).force;
  system.wrapped = arc.contacts;
  point.border.resize(system.border_unknowns());
  point.border.head(head) = old.head(head);
  for (std::size_t k = 0; k < arc.forces.size(); ++k) {
    point.border.segment<2>(system.wrapped_rows(k).force) = arc.forces[k];
  }
  keep_mounts(old, old_mount, system, point);
}

// One wrapped vertex is left: contact at a point again, at that vertex. `state`: of the point before.
void end_wrap(PushSystem& system, numerics::PathPoint& point, const wire::PlanarState& state) {
  SlidingContact& pusher = system.sliding[0];
  const WrappedContact left = system.wrapped.front();
  const Vector2d force = point.border.segment<2>(system.wrapped_rows(0).force);
  const double coordinate = system.rod().mesh().coordinate(left.node, state.controls);
  const Eigen::VectorXd old = point.border;
  const int old_mount = system.mount_row(0);
  system.wrapped.clear();
  point.border.conservativeResize(system.border_unknowns());
  keep_mounts(old, old_mount, system, point);
  move_contact_vertex(system, point, coordinate);
  pusher.status = left.status;
  pusher.slip_sign = pusher.side * left.slip_sign;
  pusher.last_coordinate = coordinate;
  pusher.last_tangent = system.tangent_at(pusher, system.state(point)).t;
  pusher.last_force = force;
  point.border.segment<2>(system.pusher_rows().force) = force;
}

}  // namespace

ContactTolerance contact_tolerance(const PushSystem& system) {
  const double length = system.length_scale();
  ContactTolerance tolerance;
  tolerance.force = 1e-9 * (system.rod().properties().bending_stiffness / (length * length) +
                            system.mount_reactions()[0].norm() + system.mount_reactions()[1].norm());
  tolerance.gap = 1e-9 * length;
  return tolerance;
}

bool begin_wrap(PushSystem& system, numerics::PathPoint& point, const ContactTolerance& tolerance) {
  SlidingContact& pusher = system.sliding[0];
  if (pusher.radius <= 0.0 || pusher.node <= 1 || pusher.node >= system.rod().mesh().edges() - 1)
    return false;
  const wire::PlanarState state = system.state(point);
  const Vector2d centre = system.pusher_centre(point);
  const double limit = pusher.radius - tolerance.gap;
  const bool left = (wire::vertex(state, pusher.node - 1) - centre).norm() < limit;
  const bool right = (wire::vertex(state, pusher.node + 1) - centre).norm() < limit;
  if (!left && !right) return false;

  const SlidingRows rows = system.pusher_rows();
  const Vector2d force = point.border.segment<2>(rows.force);
  pusher.last_coordinate = point.border[rows.coordinate];
  Arc arc;
  for (int i = pusher.node - (left ? 1 : 0); i <= pusher.node + (right ? 1 : 0); ++i) {
    WrappedContact r;
    r.node = i;
    r.friction = pusher.friction;
    r.status = pusher.friction > 0.0 ? pusher.status : ContactStatus::slip;
    // Of the pusher: sliding towards larger S means that the wire moves towards smaller angles of a pin on
    // its right.
    r.slip_sign = pusher.side * pusher.slip_sign;
    r.last_radial = (wire::vertex(state, i) - centre).normalized();
    arc.add(r, i == pusher.node ? force : Vector2d::Zero());
  }
  pusher.status = ContactStatus::wrapped;
  point.border.segment<2>(rows.force).setZero();
  point.border[rows.gap] = 0.0;
  put(arc, system, point);
  return true;
}

bool settle_wrap(PushSystem& system, numerics::PathPoint& point, const ContactTolerance& tolerance) {
  const wire::PlanarState state = system.state(point);
  const Vector2d centre = system.pusher_centre(point);
  Arc arc;
  bool changed = false;
  for (std::size_t k = 0; k < system.wrapped.size(); ++k) {
    WrappedContact r = system.wrapped[k];
    const Vector2d force = point.border.segment<2>(system.wrapped_rows(k).force);
    const Vector2d n = (wire::vertex(state, r.node) - centre).normalized();
    if (force.dot(n) < -tolerance.force) {
      changed = true;  // pulled: released, the others keep their forces
      continue;
    }
    if (settle_friction(r, n, force, system.sliding[0].radius, tolerance)) changed = true;
    arc.add(r, force);
  }
  if (!arc.contacts.empty()) arc = with_neighbours(arc, system, state, centre, tolerance, changed);
  if (!changed) return false;
  // The last one to leave is a contact at a point first.
  if (arc.contacts.empty()) arc.add(system.wrapped[system.wrapped.size() / 2], Vector2d::Zero());
  put(arc, system, point);
  if (system.wrapped.size() == 1) end_wrap(system, point, state);
  return true;
}

}  // namespace snare::coupling
