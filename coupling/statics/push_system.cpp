#include "coupling/statics/push_system.hpp"

#include "wire/equilibrium.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

namespace {

using Eigen::Matrix2d;
using Eigen::RowVector2d;
using Eigen::Vector2d;

}  // namespace

PushSystem::PushSystem(const wire::PlanarRod& rod, const wire::Controls& controls)
    : rod_(&rod), controls_(controls), length_(controls[2] - controls[0]), shortest_edge_(length_) {
  for (int e = 0; e < rod.mesh().edges(); ++e) {
    shortest_edge_ = std::min(shortest_edge_, rod.mesh().rest_length(e, controls));
  }
}

int PushSystem::riding_row(int contact) const {
  return guided_unknowns * static_cast<int>(guided.size()) + riding_unknowns * contact;
}

int PushSystem::border_unknowns() const { return mount_row() + (mount ? 1 : 0); }

wire::PlanarState PushSystem::state(const numerics::PathPoint& at) const {
  wire::PlanarState result{at.band, controls_};
  for (std::size_t k = 0; k < guided.size(); ++k) {
    result.controls[static_cast<std::size_t>(guided[k].control)] = at.border[guided_row(static_cast<int>(k)) + 2];
  }
  if (mount) result.controls[0] = at.border[mount_row()];
  if (!sections.bending.empty() || !sections.axial.empty()) result.memory = &sections;
  return result;
}

Vector2d PushSystem::pusher_force(const numerics::PathPoint& at) const {
  Vector2d force = at.border.segment<2>(0);
  for (int k = 0; k < static_cast<int>(riding.size()); ++k) force += at.border.segment<2>(riding_row(k));
  return force;
}

Vector2d PushSystem::pusher_centre(const numerics::PathPoint& at) const {
  const SlidingContact& pusher = guided.front();
  return pusher.centre + (at.parameter - compliance * pusher_force(at).dot(pusher.motion)) * pusher.motion;
}

// Adds to a border equation that contains by_centre . (pusher's centre) its derivatives by the pusher's forces.
void PushSystem::add_compliance(int row, const Vector2d& by_centre, numerics::BorderedSystem& system) const {
  if (compliance == 0.0) return;
  const Vector2d& m = guided.front().motion;
  const double factor = -compliance * by_centre.dot(m);
  system.corner.block<1, 2>(row, 0) += factor * m.transpose();
  for (int k = 0; k < static_cast<int>(riding.size()); ++k) {
    system.corner.block<1, 2>(row, riding_row(k)) += factor * m.transpose();
  }
}

VertexTangent PushSystem::tangent_at(const SlidingContact& contact, const wire::PlanarState& s) const {
  const int i = contact.node;
  const wire::MaterialMesh& mesh = rod_->mesh();
  const bool before = i > 0;
  const bool after = i < mesh.edges();
  const Vector2d x = wire::vertex(s, i);
  return vertex_tangent(before ? Vector2d(x - wire::vertex(s, i - 1)) : Vector2d(0.0, 0.0),
                        after ? Vector2d(wire::vertex(s, i + 1) - x) : Vector2d(0.0, 0.0),
                        before ? mesh.rest_length(i - 1, s.controls) : 0.0,
                        after ? mesh.rest_length(i, s.controls) : 0.0);
}

void PushSystem::assemble(const numerics::PathPoint& at, numerics::BorderedSystem& system,
                          Eigen::VectorXd& by_parameter) {
  const wire::PlanarState s = state(at);
  std::array<bool, 3> wanted{false, false, false};
  for (const SlidingContact& contact : guided) wanted[static_cast<std::size_t>(contact.control)] = true;
  if (mount) wanted[0] = true;
  rod_->assemble(s, wanted, assembly_);

  const int m = border_unknowns();
  system.reset(rod_->unknowns(), m);
  by_parameter.setZero(m);
  const int last = 2 * rod_->mesh().edges();
  reactions_ = {assembly_.gradient.segment<2>(0), assembly_.gradient.segment<2>(last)};
  for (const wire::PlanarEnd* end : {&rod_->properties().left, &rod_->properties().right}) {
    // A mount that gives carries its force in the spring, which is part of the gradient.
    if (end->kind == wire::PlanarEnd::Kind::free || std::isinf(end->translational_stiffness)) continue;
    const bool left = end == &rod_->properties().left;
    const double x = s.q[left ? 0 : last];
    reactions_[left ? 0 : 1].x() = -end->translational_stiffness * (x - end->position.x());
  }
  rod_->hold_mounts(assembly_);
  system.band_residual = assembly_.gradient;
  std::swap(system.matrix, assembly_.hessian);

  for (int k = 0; k < static_cast<int>(guided.size()); ++k) assemble_guided(k, s, at, system, by_parameter);
  for (int k = 0; k < static_cast<int>(riding.size()); ++k) assemble_riding(k, s, at, system, by_parameter);
  if (mount) assemble_mount(s, system);
}

void PushSystem::assemble_guided(int index, const wire::PlanarState& s, const numerics::PathPoint& at,
                                 numerics::BorderedSystem& system, Eigen::VectorXd& by_parameter) const {
  const SlidingContact& contact = guided[static_cast<std::size_t>(index)];
  const int base = guided_row(index);
  const int i = contact.node;
  const Vector2d force = at.border.segment<2>(base);
  const double coordinate = at.border[base + 2];
  const double gap = at.border[base + 3];
  Eigen::MatrixXd& corner = system.corner;
  Eigen::VectorXd& residual = system.border_residual;

  system.columns.emplace_back(base + 2, &assembly_.control_columns[static_cast<std::size_t>(contact.control)]);
  const bool pressed = contact.status == ContactStatus::stick || contact.status == ContactStatus::slip;
  if (pressed) {
    system.band_residual.segment<2>(2 * i) -= force;
    system.anchors.push_back({2 * i, base});
    system.anchors.push_back({2 * i + 1, base + 1});
  }
  if (contact.status == ContactStatus::wrapped) {
    // The arc is held by the riding contacts; this vertex keeps its material coordinate.
    residual.segment<2>(base) = force;
    corner(base, base) = corner(base + 1, base + 1) = 1.0;
    residual[base + 2] = coordinate - contact.last_coordinate;
    corner(base + 2, base + 2) = 1.0;
    residual[base + 3] = gap;
    corner(base + 3, base + 3) = 1.0;
    return;
  }

  const VertexTangent v = tangent_at(contact, s);
  const bool touching = contact.status == ContactStatus::touching;
  const double reach = contact.radius + (touching ? 0.0 : gap);
  const Vector2d n = contact.side * v.normal;
  const Vector2d dn = -contact.side * v.t;  // dn / d angle
  Vector2d centre = index == 0 ? pusher_centre(at) : Vector2d(contact.centre + at.parameter * contact.motion);
  if (touching) centre += gap * contact.approach();

  // d angle / d unknowns: through u of the edges before and after, and through their rest lengths.
  const RowVector2d by_u = v.angle_by_u();
  const RowVector2d by_previous = -v.before * by_u;
  const RowVector2d by_next = v.after * by_u;
  const RowVector2d by_vertex = -by_previous - by_next;
  const wire::MaterialMesh& mesh = rod_->mesh();
  const auto by_control = [&](int control) {
    double sum = 0.0;
    if (i > 0) sum += by_u.dot(v.by_before) * mesh.rest_length_derivative(i - 1, control);
    if (i < mesh.edges()) sum += by_u.dot(v.by_after) * mesh.rest_length_derivative(i, control);
    return sum;
  };
  // Adds factor * d angle to a border equation.
  const auto add_angle = [&](int row, double factor) {
    for (int a = 0; a < 2; ++a) {
      if (i > 0) system.rows.push_back({row, 2 * (i - 1) + a, factor * by_previous[a]});
      system.rows.push_back({row, 2 * i + a, factor * by_vertex[a]});
      if (i < mesh.edges()) system.rows.push_back({row, 2 * (i + 1) + a, factor * by_next[a]});
    }
    for (std::size_t k = 0; k < guided.size(); ++k) {
      corner(row, guided_row(static_cast<int>(k)) + 2) += factor * by_control(guided[k].control);
    }
    if (mount) corner(row, mount_row()) += factor * by_control(0);
  };

  // Position: x - p - (R + g) n = 0.
  residual.segment<2>(base) = wire::vertex(s, i) - centre - reach * n;
  for (int a = 0; a < 2; ++a) {
    system.rows.push_back({base + a, 2 * i + a, 1.0});
    add_angle(base + a, -reach * dn[a]);
    corner(base + a, base + 3) = touching ? -contact.approach()[a] : -n[a];
    by_parameter[base + a] = -contact.motion[a];
    if (index == 0) add_compliance(base + a, -Vector2d::Unit(a), system);
  }
  if (!pressed) {
    residual.segment<2>(base + 2) = force;
    corner(base + 2, base) = corner(base + 3, base + 1) = 1.0;
    return;
  }
  residual[base + 3] = gap;
  corner(base + 3, base + 3) = 1.0;
  if (contact.holds_material) {
    residual[base + 2] = coordinate - contact.last_coordinate;
    corner(base + 2, base + 2) = 1.0;
  } else if (contact.status == ContactStatus::stick) {
    // Rolling: dS + side R d angle = 0.
    residual[base + 2] = coordinate - contact.last_coordinate +
                         contact.side * contact.radius * angle_between(contact.last_tangent, v.t);
    corner(base + 2, base + 2) = 1.0;
    add_angle(base + 2, contact.side * contact.radius);
  } else {
    // Sliding: f.t - sign mu f.n = 0.
    const double limit = contact.slip_sign * contact.friction;
    residual[base + 2] = force.dot(v.t) - limit * force.dot(n);
    corner(base + 2, base) = v.t.x() - limit * n.x();
    corner(base + 2, base + 1) = v.t.y() - limit * n.y();
    add_angle(base + 2, force.dot(v.normal) - limit * force.dot(dn));
  }
}

void PushSystem::assemble_riding(int index, const wire::PlanarState& s, const numerics::PathPoint& at,
                                 numerics::BorderedSystem& system, Eigen::VectorXd& by_parameter) const {
  const WrappedContact& contact = riding[static_cast<std::size_t>(index)];
  const SlidingContact& pusher = guided.front();
  const int base = riding_row(index);
  const int i = contact.node;
  const Vector2d force = at.border.segment<2>(base);
  system.band_residual.segment<2>(2 * i) -= force;
  system.anchors.push_back({2 * i, base});
  system.anchors.push_back({2 * i + 1, base + 1});

  const Vector2d arm = wire::vertex(s, i) - pusher_centre(at);
  const double distance = arm.norm();
  const Vector2d n = arm / distance;
  const Vector2d tau(-n.y(), n.x());  // of increasing angle about the centre
  Eigen::MatrixXd& corner = system.corner;

  system.border_residual[base] = distance - pusher.radius;
  by_parameter[base] = -n.dot(pusher.motion);
  double residual = 0.0;
  double by_angle = 0.0;
  if (contact.status == ContactStatus::stick) {
    residual = pusher.radius * angle_between(contact.last_radial, n);
    by_angle = pusher.radius;
  } else {
    const double limit = -contact.slip_sign * contact.friction;
    residual = force.dot(tau) - limit * force.dot(n);
    corner(base + 1, base) = tau.x() - limit * n.x();
    corner(base + 1, base + 1) = tau.y() - limit * n.y();
    by_angle = -force.dot(n) - limit * force.dot(tau);
  }
  system.border_residual[base + 1] = residual;
  by_parameter[base + 1] = -by_angle * tau.dot(pusher.motion) / distance;
  add_compliance(base, -n, system);
  add_compliance(base + 1, -by_angle / distance * tau, system);
  for (int a = 0; a < 2; ++a) {
    system.rows.push_back({base, 2 * i + a, n[a]});
    system.rows.push_back({base + 1, 2 * i + a, by_angle * tau[a] / distance});
  }
}

void PushSystem::assemble_mount(const wire::PlanarState& s, numerics::BorderedSystem& system) const {
  const int row = mount_row();
  system.columns.emplace_back(row, &assembly_.control_columns[0]);
  if (!mount->slips) {
    system.border_residual[row] = s.controls[0] - mount->last_coordinate;
    system.corner(row, row) = 1.0;
    return;
  }
  // dE/dS_0 = sign * limit.
  system.border_residual[row] = assembly_.control_gradient[0] - mount->slip_sign * mount->limit;
  const Eigen::VectorXd& column = assembly_.control_columns[0];
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    if (column[i] != 0.0) system.rows.push_back({row, static_cast<int>(i), column[i]});
  }
  system.corner(row, row) = assembly_.control_hessian(0, 0);
  for (std::size_t k = 0; k < guided.size(); ++k) {
    system.corner(row, guided_row(static_cast<int>(k)) + 2) = assembly_.control_hessian(0, guided[k].control);
  }
}

double PushSystem::error(const numerics::PathPoint& at, const numerics::BorderedSystem& system) const {
  const wire::PlanarRodProperties& p = rod_->properties();
  double largest = 0.0;
  for (std::size_t k = 0; k < guided.size(); ++k) {
    largest = std::max(largest, at.border.segment<2>(guided_row(static_cast<int>(k))).norm());
  }
  const double tension = std::max(reactions_[0].norm(), reactions_[1].norm());
  const double force = wire::force_tolerance(1e-10, p.bending_stiffness, p.axial_stiffness, length_,
                                             shortest_edge_, std::max(largest, tension));
  const double position = 1e-12 * length_;
  double error = system.band_residual.lpNorm<Eigen::Infinity>() / force;
  for (std::size_t k = 0; k < guided.size(); ++k) {
    const SlidingContact& contact = guided[k];
    const auto rows = system.border_residual.segment<4>(guided_row(static_cast<int>(k)));
    const bool sliding = contact.status == ContactStatus::slip && !contact.holds_material;
    const bool apart = contact.status == ContactStatus::open || contact.status == ContactStatus::touching;
    error = std::max(error, rows.head<2>().lpNorm<Eigen::Infinity>() / (contact.status == ContactStatus::wrapped ? force : position));
    error = std::max(error, std::abs(rows[2]) / (sliding || apart ? force : position));
    error = std::max(error, std::abs(rows[3]) / (apart ? force : position));
  }
  for (std::size_t k = 0; k < riding.size(); ++k) {
    const auto rows = system.border_residual.segment<2>(riding_row(static_cast<int>(k)));
    error = std::max(error, std::abs(rows[0]) / position);
    error = std::max(error, std::abs(rows[1]) / (riding[k].status == ContactStatus::slip ? force : position));
  }
  if (mount) error = std::max(error, std::abs(system.border_residual[mount_row()]) / (mount->slips ? force : position));
  return error;
}

}  // namespace snare::coupling
