#include "coupling/statics/contact_switch.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;

// What counts as violated: forces against the rod's own, gaps against its length.
constexpr double relative_force = 1e-9;
constexpr double relative_gap = 1e-9;

double force_floor(const PushSystem& system) {
  const double length = system.length_scale();
  return relative_force * (system.rod().properties().bending_stiffness / (length * length) +
                           system.mount_reactions()[0].norm() + system.mount_reactions()[1].norm());
}

/// Slip of the material over the pin since the last accepted state: dS + side R d angle [m].
double slip_of(const SlidingContact& contact, const VertexTangent& v, double coordinate) {
  return coordinate - contact.last_coordinate +
         contact.side * contact.radius * angle_between(contact.last_tangent, v.t);
}

/// Where a function that was f0 at the start of the step and is f1 at its end crosses zero.
double crossing(double f0, double f1) {
  return f0 / (f0 - f1);
}

struct Pressed {
  double normal;      // force of the pin on the wire along its normal [N]
  double tangential;  // along the wire's tangent [N]
};

Pressed resolve(const Vector2d& force, const Vector2d& tangent, double side) {
  return {side * (-force.x() * tangent.y() + force.y() * tangent.x()), force.dot(tangent)};
}

// Sticking or sliding of a pin that is pressed. Returns true when the status changed.
bool settle_friction(SlidingContact& contact, const VertexTangent& v, const Vector2d& force, double coordinate,
                     double floor, ContactMemory& memory) {
  if (contact.friction == 0.0 || contact.holds_material) return false;
  const Pressed now = resolve(force, v.t, contact.side);
  if (contact.status == ContactStatus::stick) {
    const double excess = std::abs(now.tangential) - contact.friction * now.normal;
    if (excess <= floor) return false;
    contact.status = ContactStatus::slip;
    contact.slip_sign = now.tangential > 0.0 ? 1.0 : -1.0;
    const Pressed last = resolve(contact.last_force, contact.last_tangent, contact.side);
    const double before = contact.slip_sign * last.tangential - contact.friction * last.normal;
    if (before < -floor) memory.at_fraction(crossing(before, excess));
    memory.change();
    return true;
  }
  const double slip = slip_of(contact, v, coordinate) * contact.slip_sign;
  if (slip >= -relative_gap * 1e-3) return false;
  contact.status = ContactStatus::stick;
  memory.change();
  return true;
}

// Makes the vertices from `first` to `last` ride on the pusher.
void begin_wrap(PushSystem& system, numerics::PathPoint& point, int first, int last) {
  SlidingContact& pusher = system.guided[0];
  const wire::PlanarState state = system.state(point);
  const Vector2d centre = system.pusher_centre(point);
  const Eigen::VectorXd old = point.border;
  const int old_mount = system.mount_row();
  pusher.last_coordinate = old[2];
  for (int i = first; i <= last; ++i) {
    WrappedContact r;
    r.node = i;
    r.friction = pusher.friction;
    r.status = pusher.friction > 0.0 ? pusher.status : ContactStatus::slip;
    // Guided: sliding towards larger S means that the wire moves towards smaller angles of a pin on its right.
    r.slip_sign = pusher.side * pusher.slip_sign;
    r.last_radial = (wire::vertex(state, i) - centre).normalized();
    system.riding.push_back(r);
  }
  pusher.status = ContactStatus::wrapped;
  point.border.setZero(system.border_unknowns());
  point.border.head(old_mount) = old.head(old_mount);
  point.border.segment<2>(0).setZero();
  point.border[3] = 0.0;
  if (system.mount) point.border[system.mount_row()] = old[old_mount];
  for (int k = 0; k < static_cast<int>(system.riding.size()); ++k) {
    if (system.riding[static_cast<std::size_t>(k)].node == pusher.node) {
      point.border.segment<2>(system.riding_row(k)) = old.segment<2>(0);
    }
  }
}

// Positions at new material coordinates by the cubic through the four nearest old vertices.
void remap(PushSystem& system, numerics::PathPoint& point, double contact_coordinate) {
  const wire::PlanarState old = system.state(point);
  const wire::MaterialMesh& mesh = system.rod().mesh();
  wire::Controls controls = old.controls;
  controls[1] = contact_coordinate;
  const int last = mesh.edges();
  int j = 0;
  for (int i = 1; i < last; ++i) {
    const double s = mesh.coordinate(i, controls);
    while (j < last - 1 && mesh.coordinate(j + 1, old.controls) < s) ++j;
    const int first = std::clamp(j - 1, 0, last - 3);
    Vector2d x = Vector2d::Zero();
    for (int a = first; a < first + 4; ++a) {
      double weight = 1.0;
      for (int b = first; b < first + 4; ++b) {
        if (b == a) continue;
        const double sa = mesh.coordinate(a, old.controls);
        const double sb = mesh.coordinate(b, old.controls);
        weight *= (s - sb) / (sa - sb);
      }
      x += weight * wire::vertex(old, a);
    }
    point.band.segment<2>(2 * i) = x;
  }
  point.border[2] = contact_coordinate;
}

// One riding vertex is left: contact at a point again, at that vertex.
void end_wrap(PushSystem& system, numerics::PathPoint& point, const wire::PlanarState& state) {
  SlidingContact& pusher = system.guided[0];
  const WrappedContact left = system.riding.front();
  const Vector2d force = point.border.segment<2>(system.riding_row(0));
  const double coordinate = system.rod().mesh().coordinate(left.node, state.controls);
  const Eigen::VectorXd old = point.border;
  const int old_mount = system.mount_row();
  system.riding.clear();
  point.border.conservativeResize(system.border_unknowns());
  if (system.mount) point.border[system.mount_row()] = old[old_mount];
  remap(system, point, coordinate);
  pusher.status = left.status;
  pusher.slip_sign = pusher.side * left.slip_sign;
  pusher.last_coordinate = coordinate;
  pusher.last_tangent = system.tangent_at(pusher, system.state(point)).t;
  pusher.last_force = force;
  point.border.segment<2>(0) = force;
}

bool settle_wrapped(PushSystem& system, numerics::PathPoint& point, ContactMemory& memory, double floor) {
  const SlidingContact& pusher = system.guided[0];
  const wire::PlanarState state = system.state(point);
  const Vector2d centre = system.pusher_centre(point);
  // Release vertices that are pulled; the others keep their forces.
  std::vector<WrappedContact> kept;
  std::vector<Vector2d> forces;
  bool changed = false;
  for (int k = 0; k < static_cast<int>(system.riding.size()); ++k) {
    WrappedContact r = system.riding[static_cast<std::size_t>(k)];
    const Vector2d force = point.border.segment<2>(system.riding_row(k));
    const Vector2d n = (wire::vertex(state, r.node) - centre).normalized();
    const double normal = force.dot(n);
    if (normal < -floor) {
      changed = true;
      continue;
    }
    if (r.friction > 0.0) {
      const double tangential = force.dot(Vector2d(-n.y(), n.x()));
      if (r.status == ContactStatus::stick && std::abs(tangential) > r.friction * normal + floor) {
        r.status = ContactStatus::slip;
        r.slip_sign = tangential > 0.0 ? -1.0 : 1.0;
        changed = true;
      } else if (r.status == ContactStatus::slip &&
                 r.slip_sign * pusher.radius * angle_between(r.last_radial, n) < -relative_gap * 1e-3) {
        r.status = ContactStatus::stick;
        changed = true;
      }
    }
    kept.push_back(r);
    forces.push_back(force);
  }
  // Take in the vertices of the arc and its neighbours that are inside the pusher.
  if (!kept.empty()) {
    const int first = std::max(1, kept.front().node - 1);
    const int last = std::min(system.rod().mesh().edges() - 1, kept.back().node + 1);
    std::vector<WrappedContact> complete;
    std::vector<Vector2d> all_forces;
    std::size_t k = 0;
    for (int node = first; node <= last; ++node) {
      if (k < kept.size() && kept[k].node == node) {
        complete.push_back(kept[k]);
        all_forces.push_back(forces[k++]);
        continue;
      }
      const Vector2d arm = wire::vertex(state, node) - centre;
      if (arm.norm() >= pusher.radius - relative_gap * system.length_scale()) continue;
      WrappedContact joined = complete.empty() ? kept.front() : complete.back();
      joined.node = node;
      joined.last_radial = arm.normalized();
      complete.push_back(joined);
      all_forces.push_back(Vector2d::Zero());
      changed = true;
    }
    kept = complete;
    forces = all_forces;
  }
  if (!changed) return false;
  memory.change();
  const Eigen::VectorXd old = point.border;
  const int old_mount = system.mount_row();
  const int head = system.riding_row(0);
  if (kept.empty())
    kept.push_back(system.riding[system.riding.size() / 2]), forces.push_back(Vector2d::Zero());
  system.riding = kept;
  point.border.resize(system.border_unknowns());
  point.border.head(head) = old.head(head);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    point.border.segment<2>(system.riding_row(static_cast<int>(k))) = forces[k];
  }
  if (system.mount) point.border[system.mount_row()] = old[old_mount];
  if (system.riding.size() == 1) {
    end_wrap(system, point, state);
    memory.change();
  }
  return true;
}

bool settle_mount(PushSystem& system, const numerics::PathPoint& point, ContactMemory& memory, double floor) {
  SlippingMount& mount = *system.mount;
  const double drive = system.rod_assembly().control_gradient[0];
  const double coordinate = point.border[system.mount_row()];
  if (!mount.slips) {
    if (std::abs(drive) <= mount.limit + floor) return false;
    mount.slips = true;
    mount.slip_sign = drive > 0.0 ? 1.0 : -1.0;
    memory.change();
    return true;
  }
  // A pull (drive > 0) feeds wire in: S_0 falls.
  if ((coordinate - mount.last_coordinate) * mount.slip_sign <= relative_gap * 1e-3) return false;
  mount.slips = false;
  memory.change();
  return true;
}

}  // namespace

std::vector<PushEvent::Kind> contact_events(const ContactStates& before, const ContactStates& after) {
  using Kind = PushEvent::Kind;
  std::vector<Kind> events;
  const ContactStatus was = before.guided[0].status;
  const ContactStatus is = after.guided[0].status;
  const bool frictional = after.guided[0].friction > 0.0;
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
             before.guided[0].slip_sign != after.guided[0].slip_sign) {
    events.push_back(Kind::slip_ends);
    events.push_back(Kind::slip_begins);
  }
  if (after.mount && before.mount && after.mount->slips != before.mount->slips) {
    events.push_back(after.mount->slips ? Kind::mount_slips : Kind::mount_holds);
  }
  return events;
}

bool settle_contact(PushSystem& system, numerics::PathPoint& point, ContactMemory& memory) {
  const double floor = force_floor(system);
  if (system.mount && settle_mount(system, point, memory, floor)) return true;
  SlidingContact& pusher = system.guided[0];
  if (pusher.status == ContactStatus::wrapped) return settle_wrapped(system, point, memory, floor);

  const wire::PlanarState state = system.state(point);
  if (pusher.status == ContactStatus::open) {
    const double gap = point.border[3];
    if (gap >= -relative_gap * system.length_scale()) return false;
    if (pusher.last_gap > relative_gap * system.length_scale())
      memory.at_fraction(crossing(pusher.last_gap, gap));
    pusher.status = pusher.friction > 0.0 ? ContactStatus::stick : ContactStatus::slip;
    pusher.last_coordinate = point.border[2];
    pusher.last_tangent = system.tangent_at(pusher, state).t;
    point.border[3] = 0.0;
    memory.change();
    return true;
  }
  for (int k = 0; k < static_cast<int>(system.guided.size()); ++k) {
    SlidingContact& contact = system.guided[static_cast<std::size_t>(k)];
    const VertexTangent v = system.tangent_at(contact, state);
    const Vector2d force = point.border.segment<2>(system.guided_row(k));
    const Pressed now = resolve(force, v.t, contact.side);
    if (k == 0 && now.normal < -floor) {
      if (contact.status == ContactStatus::stick && contact.last_force.norm() <= floor) {
        // The first touch of a steep wire: sticking would pull. It slides, or leaves.
        contact.status = ContactStatus::slip;
        contact.slip_sign = now.tangential > 0.0 ? 1.0 : -1.0;
        memory.change();
        return true;
      }
      const Pressed last = resolve(contact.last_force, contact.last_tangent, contact.side);
      if (last.normal > floor) memory.at_fraction(crossing(last.normal, now.normal));
      contact.status = ContactStatus::open;
      point.border.segment<2>(0).setZero();
      memory.change();
      return true;
    }
    if (settle_friction(contact, v, force, point.border[system.guided_row(k) + 2], floor, memory))
      return true;
  }
  if (pusher.radius > 0.0 && pusher.node > 1 && pusher.node < system.rod().mesh().edges() - 1) {
    const Vector2d centre = system.pusher_centre(point);
    const double limit = pusher.radius - relative_gap * system.length_scale();
    const bool left = (wire::vertex(state, pusher.node - 1) - centre).norm() < limit;
    const bool right = (wire::vertex(state, pusher.node + 1) - centre).norm() < limit;
    if (left || right) {
      begin_wrap(system, point, pusher.node - (left ? 1 : 0), pusher.node + (right ? 1 : 0));
      memory.change();
      return true;
    }
  }
  return false;
}

void remember_contact(PushSystem& system, const numerics::PathPoint& point) {
  const wire::PlanarState state = system.state(point);
  for (int k = 0; k < static_cast<int>(system.guided.size()); ++k) {
    SlidingContact& contact = system.guided[static_cast<std::size_t>(k)];
    contact.last_coordinate = point.border[system.guided_row(k) + 2];
    contact.last_tangent = system.tangent_at(contact, state).t;
    contact.last_force = point.border.segment<2>(system.guided_row(k));
    contact.last_gap = point.border[system.guided_row(k) + 3];
  }
  const Vector2d centre = system.pusher_centre(point);
  for (int k = 0; k < static_cast<int>(system.riding.size()); ++k) {
    WrappedContact& contact = system.riding[static_cast<std::size_t>(k)];
    contact.last_radial = (wire::vertex(state, contact.node) - centre).normalized();
    contact.last_force = point.border.segment<2>(system.riding_row(k));
  }
  if (system.mount) system.mount->last_coordinate = point.border[system.mount_row()];
  if (system.rod().has_memory()) system.sections = system.rod().remembered(state);
}

double friction_work(const PushSystem& system, const numerics::PathPoint& before,
                     const numerics::PathPoint& now) {
  const wire::PlanarState state = system.state(now);
  double work = 0.0;
  for (int k = 0; k < static_cast<int>(system.guided.size()); ++k) {
    const SlidingContact& contact = system.guided[static_cast<std::size_t>(k)];
    if (contact.friction == 0.0 || contact.status != ContactStatus::slip || contact.holds_material) continue;
    const VertexTangent v = system.tangent_at(contact, state);
    const int row = system.guided_row(k);
    const double last = contact.last_force.dot(contact.last_tangent);
    const double force = now.border.segment<2>(row).dot(v.t);
    // The pin drags the wire along +t while material passes it towards larger S.
    work += 0.5 * std::abs(last + force) * std::abs(slip_of(contact, v, now.border[row + 2]));
  }
  const Vector2d centre = system.pusher_centre(now);
  for (int k = 0; k < static_cast<int>(system.riding.size()); ++k) {
    const WrappedContact& contact = system.riding[static_cast<std::size_t>(k)];
    if (contact.friction == 0.0 || contact.status != ContactStatus::slip) continue;
    const Vector2d n = (wire::vertex(state, contact.node) - centre).normalized();
    const Vector2d& r = contact.last_radial;
    const double last = contact.last_force.dot(Vector2d(-r.y(), r.x()));
    const double force = now.border.segment<2>(system.riding_row(k)).dot(Vector2d(-n.y(), n.x()));
    work += 0.5 * std::abs(last + force) * system.guided[0].radius * std::abs(angle_between(r, n));
  }
  if (system.mount && system.mount->slips && before.border.size() == now.border.size()) {
    const int row = system.mount_row();
    work += system.mount->limit * std::abs(now.border[row] - system.mount->last_coordinate);
  }
  return work;
}

PusherForces pusher_forces(const PushSystem& system, const wire::PlanarState& state,
                           const numerics::PathPoint& at) {
  const SlidingContact& pusher = system.guided[0];
  PusherForces sum;
  if (system.riding.empty()) {
    const Pressed p = resolve(at.border.segment<2>(0), system.tangent_at(pusher, state).t, pusher.side);
    sum.slipping = pusher.friction > 0.0 && pusher.status == ContactStatus::slip;
    sum.normal = p.normal;
    sum.friction = p.tangential;
    return sum;
  }
  const Vector2d centre = system.pusher_centre(at);
  sum.slipping = pusher.friction > 0.0;
  for (int k = 0; k < static_cast<int>(system.riding.size()); ++k) {
    const WrappedContact& r = system.riding[static_cast<std::size_t>(k)];
    const Vector2d n = (wire::vertex(state, r.node) - centre).normalized();
    const Vector2d force = at.border.segment<2>(system.riding_row(k));
    sum.normal += force.dot(n);
    // Along increasing arc length, which runs against the angle about a pin on the right of the wire.
    sum.friction += -pusher.side * force.dot(Vector2d(-n.y(), n.x()));
    sum.slipping = sum.slipping && r.status == ContactStatus::slip;
  }
  return sum;
}

MountForces mount_forces(const PushSystem& system, const wire::PlanarState& state,
                         const numerics::PathPoint& at) {
  MountForces result;
  const wire::PlanarRodProperties& p = system.rod().properties();
  std::array<Vector2d, 2> reaction = system.mount_reactions();
  if (p.left.kind == wire::PlanarEnd::Kind::free) {
    for (int k = 1; k < static_cast<int>(system.guided.size()); ++k) {
      reaction[static_cast<std::size_t>(k - 1)] = at.border.segment<2>(system.guided_row(k));
    }
    const Eigen::VectorXd tensions = system.rod().tensions(state);
    result.tension_left = tensions[0];
    result.tension_right = tensions[tensions.size() - 1];
  } else {
    result.tension_left = -reaction[0].dot(p.left.direction);
    result.tension_right = reaction[1].dot(p.right.direction);
  }
  const double length = state.controls[2] - state.controls[0];
  result.total = reaction[0] + reaction[1] + length * p.weight;
  return result;
}

ContactExtent contact_extent(const PushSystem& system, const wire::PlanarState& state) {
  if (system.riding.empty()) return {state.controls[1], 0.0};
  const wire::MaterialMesh& mesh = system.rod().mesh();
  const double first = mesh.coordinate(system.riding.front().node, state.controls);
  const double last = mesh.coordinate(system.riding.back().node, state.controls);
  return {0.5 * (first + last), last - first};
}

bool reseat_contact(PushSystem& system, numerics::PathPoint& point, numerics::PathWorkspace& workspace) {
  const Vector2d centre = system.pusher_centre(point);
  const wire::PlanarState state = system.state(point);
  int nearest = 1;
  for (int i = 2; i < system.rod().mesh().edges(); ++i) {
    if ((wire::vertex(state, i) - centre).norm() < (wire::vertex(state, nearest) - centre).norm())
      nearest = i;
  }
  SlidingContact& pusher = system.guided[0];
  pusher.status = ContactStatus::open;
  point.border.segment<2>(0).setZero();
  remap(system, point, system.rod().mesh().coordinate(nearest, state.controls));
  const wire::PlanarState moved = system.state(point);
  const VertexTangent v = system.tangent_at(pusher, moved);
  point.border[3] = pusher.side * v.normal.dot(wire::vertex(moved, pusher.node) - centre) - pusher.radius;
  const numerics::SolveReport report = numerics::correct(system, point, workspace, 50);
  if (!report.usable()) return false;
  if (point.border[3] >= 0.0) return true;
  pusher.status = pusher.friction > 0.0 ? ContactStatus::stick : ContactStatus::slip;
  pusher.last_coordinate = point.border[2];
  pusher.last_tangent = system.tangent_at(pusher, system.state(point)).t;
  point.border[3] = 0.0;
  if (!numerics::correct(system, point, workspace, 50).usable()) return false;
  const VertexTangent pressed = system.tangent_at(pusher, system.state(point));
  return pusher.side * pressed.normal.dot(point.border.segment<2>(0)) >= 0.0;
}

}  // namespace snare::coupling
