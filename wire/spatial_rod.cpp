#include "wire/spatial_rod.hpp"

#include "wire/spatial_cell.hpp"

#include <Eigen/Geometry>

#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

namespace snare::wire {

using Eigen::Vector3d;

SpatialRod::SpatialRod(MaterialMesh mesh, const SpatialRodProperties& properties, Strains strains)
    : mesh_(std::move(mesh)), properties_(properties), strains_(strains) {
  assert(properties.bending_stiffness > 0.0 && properties.second_bending_stiffness > 0.0);
  assert(properties.torsional_stiffness > 0.0 && properties.axial_stiffness > 0.0);
}

void SpatialRod::set_mounts(const SpatialEnd& left, const SpatialEnd& right) {
  properties_.left = left;
  properties_.right = right;
}

namespace {

/// Frame of a mount that holds the end's direction; none of another.
std::optional<Frame> mount_frame(const SpatialEnd& end) {
  if (!end.orients()) return std::nullopt;
  return Frame{end.direction, end.director};
}

}  // namespace

SpatialState SpatialRod::make_state(const Eigen::VectorXd& q, const Controls& controls) const {
  assert(q.size() == unknowns());
  const int n = mesh_.edges();
  SpatialState state;
  state.q = q;
  state.controls = controls;
  state.frames.resize(base::at(n));
  state.reference_twist.assign(base::at(n + 1), 0.0);
  const auto tangent = [&](int e) { return Vector3d(vertex(state, e + 1) - vertex(state, e)).normalized(); };
  state.left_mount = mount_frame(properties_.left);
  state.right_mount = mount_frame(properties_.right);
  Frame frame = state.left_mount.value_or(Frame{tangent(0), any_normal(tangent(0))});
  if (!state.left_mount && state.right_mount) {  // untwisted from the end that is held
    frame = *state.right_mount;
    for (int e = n - 1; e >= 0; --e) frame = transport(frame, tangent(e));
  }
  for (int e = 0; e < n; ++e) {
    frame = transport(frame, tangent(e));
    state.frames[base::at(e)] = frame;
  }
  if (state.right_mount) state.reference_twist.back() = reference_twist(frame, *state.right_mount, 0.0);
  return state;
}

SpatialState SpatialRod::straight_state(const Controls& controls) const {
  const double length = controls.length();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(unknowns());
  for (int i = 0; i < mesh_.vertices(); ++i) {
    const double share = (mesh_.coordinate(i, controls) - controls.left) / length;
    q.segment<3>(block * i) = (1.0 - share) * properties_.left.position + share * properties_.right.position;
  }
  return make_state(q, controls);
}

void SpatialRod::adopt_mounts(SpatialState& state) const {
  Eigen::VectorXd q = state.q;
  const auto place = [&q](const SpatialEnd& end, int row) {
    if (end.kind == SpatialEnd::Kind::free) return;
    if (std::isinf(end.translational_stiffness)) q[row] = end.position.x();
    q.segment<2>(row + 1) = end.position.tail<2>();
  };
  place(properties_.left, row_of(End::left));
  place(properties_.right, row_of(End::right));
  state.left_mount = mount_frame(properties_.left);
  state.right_mount = mount_frame(properties_.right);
  accept(state, q);
}

double SpatialRod::energy(const SpatialState& state) const {
  double sum = properties_.left.spring_energy(state.q[row_of(End::left)]) +
               properties_.right.spring_energy(state.q[row_of(End::right)]);
  const int n = mesh_.edges();
  const CellTerms terms(properties_, strains_);
  visit_cells(mesh_, state, terms,
              [&](int i, const SpatialCell& cell, const SpatialEdge&, const SpatialEdge& after) {
                sum += cell.energy;
                if (i == n) return;
                const double strain = after.length / after.rest - 1.0;
                sum += 0.5 * terms.axial_stiffness * strain * strain * after.rest;
                sum -= 0.5 * after.rest * properties_.weight.dot(vertex(state, i) + vertex(state, i + 1));
              });
  return sum;
}

namespace {

/// The cell at one end with its edges, one of them the mount.
struct MountedCell {
  SpatialEdge before, after;
  SpatialCell cell;
};

MountedCell mounted_cell(const MaterialMesh& mesh, const SpatialState& state, const CellTerms& terms,
                         End end) {
  const int n = mesh.edges();
  const bool left = end == End::left;
  MountedCell m;
  m.before =
      left ? mount_edge(terms.properties.left, state.left_mount, terms) : edge_at(n - 1, mesh, state, terms);
  m.after =
      left ? edge_at(0, mesh, state, terms) : mount_edge(terms.properties.right, state.right_mount, terms);
  m.cell = cell_at(left ? 0 : n, n, m.before, m.after, state, terms);
  return m;
}

}  // namespace

SpatialRod::EndCell SpatialRod::end_cell(const SpatialState& state, End end) const {
  const MountedCell m = mounted_cell(mesh_, state, CellTerms(properties_, strains_), end);
  EndCell result;
  if (!m.cell.bends && !m.cell.twists) return result;
  const PairGradient g = gradient_of(m.cell, m.before, m.after);
  const PairHessian h = hessian_of(m.cell, m.before, m.after);
  result.gradient = end == End::left ? g.of_after() : g.of_before();
  result.hessian = end == End::left ? h.of_after() : h.of_before();
  return result;
}

void SpatialRod::add_end_forces(const SpatialState& state, End end, RodAssembly& out) const {
  const SpatialEnd& mount = properties_.end(end);
  const int row = row_of(end);
  out.energy += mount.spring_energy(state.q[row]);
  if (mount.gives()) out.gradient[row] += mount.translational_stiffness * (state.q[row] - mount.position.x());
  const MountedCell m = mounted_cell(mesh_, state, CellTerms(properties_, strains_), end);
  if (!m.cell.bends && !m.cell.twists) return;
  out.energy += m.cell.energy;
  const PairGradient g = gradient_of(m.cell, m.before, m.after);
  const bool left = end == End::left;
  const int edge = left ? 0 : mesh_.edges() - 1;
  const Vector3d& force = left ? g.b : g.a;
  out.gradient.segment<3>(block * edge) -= force;
  out.gradient.segment<3>(block * (edge + 1)) += force;
  out.gradient[block * edge + angle] += left ? g.theta_b : g.theta_a;
}

Eigen::Matrix3Xd SpatialRod::moments(const SpatialState& state) const {
  Eigen::Matrix3Xd result(3, mesh_.vertices());
  visit_cells(mesh_, state, CellTerms(properties_, strains_),
              [&](int i, const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after) {
                result.col(i) = moment_of(cell, before, after);
              });
  return result;
}

std::array<Vector3d, 2> SpatialRod::end_moments(const SpatialState& state) const {
  const CellTerms terms(properties_, strains_);
  const auto moment = [&](End end) {
    const MountedCell m = mounted_cell(mesh_, state, terms, end);
    return moment_of(m.cell, m.before, m.after);
  };
  return {moment(End::left), moment(End::right)};
}

Eigen::VectorXd SpatialRod::torques(const SpatialState& state) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(mesh_.vertices());
  visit_cells(mesh_, state, CellTerms(properties_, strains_),
              [&](int i, const SpatialCell& cell, const SpatialEdge&, const SpatialEdge&) {
                result[i] = cell.torque;
              });
  return result;
}

Eigen::VectorXd SpatialRod::tensions(const SpatialState& state) const {
  Eigen::VectorXd result(mesh_.edges());
  for (int e = 0; e < mesh_.edges(); ++e) {
    const double length = (vertex(state, e + 1) - vertex(state, e)).norm();
    result[e] = properties_.axial_stiffness * (length / mesh_.rest_length(e, state.controls) - 1.0);
  }
  return result;
}

}  // namespace snare::wire
