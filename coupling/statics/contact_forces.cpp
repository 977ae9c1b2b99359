#include "coupling/statics/contact_forces.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

using Eigen::Vector2d;
using Eigen::Vector3d;

PinForce resolve(const Vector2d& force, const Vector2d& tangent, double side) {
  return {side * (-force.x() * tangent.y() + force.y() * tangent.x()), force.dot(tangent)};
}

double slip_of(const SlidingContact& contact, const VertexTangent& now, double coordinate) {
  return coordinate - contact.last_coordinate +
         contact.side * contact.radius * angle_between(contact.last_tangent, now.t);
}

double friction_work(const PushSystem& system, const ContactStates& states_before,
                     const numerics::PathPoint& before, const numerics::PathPoint& now) {
  const wire::PlanarState state = system.state(now);
  double work = 0.0;
  for (std::size_t k = 0; k < system.sliding.size(); ++k) {
    const SlidingContact& contact = system.sliding[k];
    const ContactStatus slid =
        contact.status == ContactStatus::open ? states_before.sliding[k].status : contact.status;
    if (contact.friction == 0.0 || slid != ContactStatus::slip || contact.holds_material) continue;
    const VertexTangent v = system.tangent_at(contact, state);
    const SlidingRows rows = system.sliding_rows(k);
    const double last = std::abs(contact.last_force.dot(contact.last_tangent));
    const double force = std::abs(now.border.segment<2>(rows.force).dot(v.t));
    work +=
        contact.slip_work.over(slip_of(contact, v, now.border[rows.coordinate]), now.parameter, last, force);
  }
  const Vector2d centre = system.pusher_centre(now);
  for (std::size_t k = 0; k < system.wrapped.size(); ++k) {
    const WrappedContact& contact = system.wrapped[k];
    if (contact.friction == 0.0 || contact.status != ContactStatus::slip) continue;
    const Vector2d n = (wire::vertex(state, contact.node) - centre).normalized();
    const Vector2d& r = contact.last_radial;
    const double last = std::abs(contact.last_force.dot(left_of(r)));
    const double force = std::abs(now.border.segment<2>(system.wrapped_rows(k).force).dot(left_of(n)));
    work +=
        contact.slip_work.over(system.sliding[0].radius * angle_between(r, n), now.parameter, last, force);
  }
  if (before.border.size() != now.border.size()) return work;
  for (std::size_t k = 0; k < system.mounts.size(); ++k) {
    const SlippingMount& mount = system.mounts[k];
    if (mount.slips || (mount.follows && system.mounts.front().slips))
      work += mount.limit * std::abs(mount.moved(system.mount_place(k, now)));
  }
  return work;
}

PusherForces pusher_forces(const PushSystem& system, const wire::PlanarState& state,
                           const numerics::PathPoint& at) {
  const SlidingContact& pusher = system.sliding[0];
  PusherForces sum;
  if (system.wrapped.empty()) {
    const Vector2d force = at.border.segment<2>(system.pusher_rows().force);
    const PinForce p = resolve(force, system.tangent_at(pusher, state).t, pusher.side);
    sum.slipping = pusher.friction > 0.0 && pusher.status == ContactStatus::slip;
    sum.normal = p.normal;
    sum.friction = p.tangential;
    return sum;
  }
  const Vector2d centre = system.pusher_centre(at);
  sum.slipping = pusher.friction > 0.0;
  for (std::size_t k = 0; k < system.wrapped.size(); ++k) {
    const WrappedContact& r = system.wrapped[k];
    const Vector2d n = (wire::vertex(state, r.node) - centre).normalized();
    const Vector2d force = at.border.segment<2>(system.wrapped_rows(k).force);
    sum.normal += force.dot(n);
    // Along increasing arc length, which runs against the angle about a pin on the right of the wire.
    sum.friction += -pusher.side * force.dot(left_of(n));
    sum.slipping = sum.slipping && r.status == ContactStatus::slip;
  }
  return sum;
}

std::array<Vector2d, 2> mount_forces(const PushSystem& system, const numerics::PathPoint& at) {
  std::array<Vector2d, 2> reaction = system.mount_reactions();
  if (system.rod().properties().left.kind == wire::PlanarEnd::Kind::free) {
    // The supports follow the pusher among the contacts.
    for (std::size_t k = 1; k < system.sliding.size(); ++k) {
      reaction[k - 1] = at.border.segment<2>(system.sliding_rows(k).force);
    }
  }
  return reaction;
}

void put_end_forces(const std::array<Vector3d, 2>& reactions, const std::array<Vector3d, 2>& tangents,
                    const Eigen::VectorXd& tensions, PushPoint& point) {
  point.reaction_along_left = reactions[0].x();
  point.reaction_across_left = reactions[0].y();
  point.reaction_z_left = reactions[0].z();
  point.reaction_along_right = reactions[1].x();
  point.reaction_across_right = reactions[1].y();
  point.reaction_z_right = reactions[1].z();
  point.tension_left = -reactions[0].dot(tangents[0]);
  point.tension_right = reactions[1].dot(tangents[1]);
  point.largest_tension = std::max({tensions.maxCoeff(), point.tension_left, point.tension_right});
}

ContactExtent contact_extent(const PushSystem& system, const wire::PlanarState& state) {
  if (system.wrapped.empty()) return {state.controls[1], 0.0};
  const wire::MaterialMesh& mesh = system.rod().mesh();
  const double first = mesh.coordinate(system.wrapped.front().node, state.controls);
  const double last = mesh.coordinate(system.wrapped.back().node, state.controls);
  return {0.5 * (first + last), last - first};
}

}  // namespace snare::coupling
