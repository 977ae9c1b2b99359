#include "coupling/statics/contact_vertex.hpp"

#include <algorithm>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;

constexpr int most_corrections = 50;  // from a shape that was only interpolated

}  // namespace

void move_contact_vertex(PushSystem& system, numerics::PathPoint& point, double coordinate) {
  const wire::PlanarState old = system.state(point);
  const wire::MaterialMesh& mesh = system.rod().mesh();
  wire::Controls controls = old.controls;
  controls[1] = coordinate;
  const int last = mesh.edges();
  int j = 0;
  for (int i = 1; i < last; ++i) {
    const double s = mesh.coordinate(i, controls);
    while (j < last - 1 && mesh.coordinate(j + 1, old.controls) < s) ++j;
    // Lagrange's cubic x(s) = sum_a x_a prod_b (s - s_b)/(s_a - s_b).
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
  point.border[system.pusher_rows().coordinate] = coordinate;
}

bool reseat_contact(PushSystem& system, numerics::PathPoint& point, numerics::PathWorkspace& workspace) {
  const Vector2d centre = system.pusher_centre(point);
  const wire::PlanarState state = system.state(point);
  int nearest = 1;
  for (int i = 2; i < system.rod().mesh().edges(); ++i) {
    if ((wire::vertex(state, i) - centre).norm() < (wire::vertex(state, nearest) - centre).norm())
      nearest = i;
  }
  SlidingContact& pusher = system.sliding[0];
  const SlidingRows rows = system.pusher_rows();
  pusher.status = ContactStatus::open;
  point.border.segment<2>(rows.force).setZero();
  move_contact_vertex(system, point, system.rod().mesh().coordinate(nearest, state.controls));
  const wire::PlanarState moved = system.state(point);
  const VertexTangent v = system.tangent_at(pusher, moved);
  point.border[rows.gap] =
      pusher.side * v.normal.dot(wire::vertex(moved, pusher.node) - centre) - pusher.radius;
  if (!numerics::correct(system, point, workspace, most_corrections).usable()) return false;
  if (point.border[rows.gap] >= 0.0) return true;
  // Inside the pusher: pressed out.
  pusher.status = pusher.friction > 0.0 ? ContactStatus::stick : ContactStatus::slip;
  pusher.last_coordinate = point.border[rows.coordinate];
  pusher.last_tangent = system.tangent_at(pusher, system.state(point)).t;
  point.border[rows.gap] = 0.0;
  if (!numerics::correct(system, point, workspace, most_corrections).usable()) return false;
  const VertexTangent pressed = system.tangent_at(pusher, system.state(point));
  return pusher.side * pressed.normal.dot(point.border.segment<2>(rows.force)) >= 0.0;
}

}  // namespace snare::coupling
