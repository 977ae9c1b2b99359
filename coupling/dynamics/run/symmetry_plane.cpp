#include "coupling/dynamics/run/symmetry_plane.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

using Eigen::Vector3d;

namespace {

/// Across an axis of the world, at a place on it.
struct SymmetryPlane {
  int normal;
  double offset;
};

constexpr double round_off = 1e-12;

bool has_place(const SymmetryPlane& plane, const Vector3d& p) {
  return std::abs(p[plane.normal] - plane.offset) <= round_off;
}

bool has_motion(const SymmetryPlane& plane, const Vector3d& v) {
  return v[plane.normal] == 0.0;
}

/// Whether a vector along an axis, as a spin or a couple, stands across the plane.
bool is_normal(const SymmetryPlane& plane, const Vector3d& axial) {
  return (axial - axial[plane.normal] * Vector3d::Unit(plane.normal)).isZero(0.0);
}

bool is_mirrored(const SymmetryPlane& plane, const MotionWire& wire) {
  return has_place(plane, wire.positions.col(0)) &&
         (wire.velocities.size() == 0 || wire.velocities.row(plane.normal).isZero(0.0));
}

bool is_mirrored(const SymmetryPlane& plane, const MotionBody& body) {
  if (body.robot || body.course_velocity) return false;
  const multibody::RigidBodyState& s = body.start;
  return has_place(plane, s.position) && is_normal(plane, s.orientation.vec()) &&
         has_motion(plane, s.velocity) && is_normal(plane, s.spin) && has_motion(plane, body.force) &&
         is_normal(plane, body.properties.inertia.col(plane.normal)) &&
         is_normal(plane, body.properties.inertia.row(plane.normal));
}

bool is_mirrored(const SymmetryPlane& plane, const MotionContact& contact, const MotionBody& body) {
  const multibody::RigidBodyState& s = body.start;
  const Vector3d normal = Vector3d::Unit(plane.normal);
  const Vector3d origin = s.position + s.orientation * contact.X_BS.p;
  return contact.shape->is_mirrored(contact.X_BS.R.transpose() * (s.orientation.conjugate() * normal),
                                    plane.offset - origin[plane.normal]);
}

bool is_mirrored(const SymmetryPlane& plane, const Motion& motion) {
  return has_motion(plane, motion.gravity) &&
         std::ranges::all_of(motion.wires, [&](const MotionWire& w) { return is_mirrored(plane, w); }) &&
         std::ranges::all_of(motion.bodies, [&](const MotionBody& b) { return is_mirrored(plane, b); }) &&
         std::ranges::all_of(motion.contacts, [&](const MotionContact& c) {
           return is_mirrored(plane, c, motion.bodies[base::at(c.body)]);
         });
}

}  // namespace

std::optional<int> symmetry_normal(const Motion& motion) {
  const bool has_more = !motion.point_contacts.empty() || !motion.wire_pairs.empty() ||
                        !motion.arms.empty() || !motion.welds.empty() || !motion.mounts.empty() ||
                        !motion.bushings.empty() || !motion.law_wires.empty() ||
                        !motion.body_contacts.empty() || !motion.loads.empty();
  if (motion.wires.empty() || has_more) return std::nullopt;
  for (const int normal : {2, 1, 0}) {
    const SymmetryPlane plane{normal, motion.wires.front().positions(normal, 0)};
    if (is_mirrored(plane, motion)) return normal;
  }
  return std::nullopt;
}

}  // namespace snare::coupling
