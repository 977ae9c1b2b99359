#include "coupling/statics/push_system.hpp"

#include "wire/planar_gradient.hpp"
#include "wire/statics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::coupling {

namespace {

using Eigen::RowVector2d;
using Eigen::Vector2d;

bool is_pressed(const SlidingContact& contact) {
  return contact.status == ContactStatus::stick || contact.status == ContactStatus::slip;
}

/// A wire that has left the pusher lies on supports without friction: nothing else would hold it along them.
bool keeps_from_afar(const SlidingContact& contact) {
  const bool apart = contact.status == ContactStatus::open || contact.status == ContactStatus::touching;
  return apart && contact.holds_material && contact.friction == 0.0;
}

}  // namespace

PushSystem::PushSystem(const wire::PlanarRod& rod, const wire::Controls& controls)
    : rod_(&rod), controls_(controls), length_(controls[2] - controls[0]), shortest_edge_(length_) {
  for (int e = 0; e < rod.mesh().edges(); ++e) {
    shortest_edge_ = std::min(shortest_edge_, rod.mesh().rest_length(e, controls));
  }
}

WrappedRows PushSystem::wrapped_rows(std::size_t contact) const {
  return WrappedRows(sliding_rows(sliding.size()).force + WrappedRows::count * static_cast<int>(contact));
}

int PushSystem::border_unknowns() const {
  return mount_row(mounts.size());
}

std::vector<SlippingMount> slipping_mounts(const wire::MountSpecification& mount, double friction,
                                           const wire::Controls& controls) {
  std::vector<SlippingMount> result;
  if (!mount.slip_tension) return result;
  for (const bool right : {false, true}) {
    if (mount.slip_at == (right ? wire::SlipPlace::left : wire::SlipPlace::right)) continue;
    SlippingMount one{.right = right, .kind = mount.slip, .limit = *mount.slip_tension};
    if (one.feeds()) {
      one.follows = !result.empty() && friction == 0.0;
      one.last = controls[static_cast<std::size_t>(one.control())];
    } else {
      one.last = right ? mount.span : 0.0;
      one.compliance = 1.0 / mount.translational_stiffness_of(right ? 1 : 0);
    }
    result.push_back(one);
  }
  return result;
}

void PushSystem::carry_sections(double travel) {
  wire::Controls to = drift.controls;
  for (std::size_t k = 0; k < 3; ++k) to[k] += (travel - drift.travel) * drift.rate[k];
  carry_sections(to);
}

void PushSystem::follow_drift(const wire::Controls& controls, double travel) {
  const double step = travel - drift.travel;
  if (has_rate(step)) {
    for (std::size_t k = 0; k < 3; ++k) drift.rate[k] = (controls[k] - drift.controls[k]) / step;
  }
  drift.controls = controls;
  drift.travel = travel;
}

void PushSystem::carry_sections(const wire::Controls& to) {
  const auto carry = [&](std::vector<double>& values, const std::vector<wire::SliderElement>& elements,
                         bool of_edges) {
    values = wire::carried_over(rod_->mesh(), values, static_cast<int>(elements.size()), of_edges,
                                sections.controls, to);
  };
  carry(sections.bending, rod_->properties().bending_sliders, false);
  carry(sections.axial, rod_->properties().axial_sliders, true);
  sections.controls = to;
}

wire::PlanarState PushSystem::state(const numerics::PathPoint& at) const {
  wire::PlanarState result{at.band, controls_};
  for (std::size_t k = 0; k < sliding.size(); ++k) {
    result.controls[static_cast<std::size_t>(sliding[k].control)] = at.border[sliding_rows(k).coordinate];
  }
  for (std::size_t k = 0; k < mounts.size(); ++k) {
    if (mounts[k].feeds())
      result.controls[static_cast<std::size_t>(mounts[k].control())] = at.border[mount_row(k)];
  }
  if (!sections.bending.empty() || !sections.axial.empty()) result.memory = &sections;
  return result;
}

Vector2d PushSystem::pusher_force(const numerics::PathPoint& at) const {
  Vector2d force = at.border.segment<2>(pusher_rows().force);
  for (std::size_t k = 0; k < wrapped.size(); ++k) force += at.border.segment<2>(wrapped_rows(k).force);
  return force;
}

Vector2d PushSystem::pusher_centre(const numerics::PathPoint& at) const {
  const SlidingContact& pusher = sliding.front();
  return pusher.centre + (at.parameter - compliance * pusher_force(at).dot(pusher.motion)) * pusher.motion;
}

// Adds to a border equation that contains by_centre . (pusher's centre) its derivatives by the pusher's
// forces: d centre/d f = -compliance m m^T.
void PushSystem::add_compliance(int row, const Vector2d& by_centre, numerics::BorderedSystem& system) const {
  if (compliance == 0.0) return;
  const Vector2d& m = sliding.front().motion;
  const double factor = -compliance * by_centre.dot(m);
  system.corner.block<1, 2>(row, pusher_rows().force) += factor * m.transpose();
  for (std::size_t k = 0; k < wrapped.size(); ++k) {
    system.corner.block<1, 2>(row, wrapped_rows(k).force) += factor * m.transpose();
  }
}

VertexTangent PushSystem::tangent_at(const SlidingContact& contact, const wire::PlanarState& s) const {
  const int i = contact.node;
  const wire::MaterialMesh& mesh = rod_->mesh();
  const bool before = i > 0;
  const bool after = i < mesh.edges();
  const Vector2d x = wire::vertex(s, i);
  return vertex_tangent(vertex_slope<2>(before ? Vector2d(x - wire::vertex(s, i - 1)) : Vector2d(0.0, 0.0),
                                        after ? Vector2d(wire::vertex(s, i + 1) - x) : Vector2d(0.0, 0.0),
                                        before ? mesh.rest_length(i - 1, s.controls) : 0.0,
                                        after ? mesh.rest_length(i, s.controls) : 0.0));
}

void PushSystem::assemble(const numerics::PathPoint& at, numerics::BorderedSystem& system,
                          Eigen::VectorXd& by_parameter) {
  const wire::PlanarState s = state(at);
  std::array<bool, 3> wanted{false, false, false};
  for (const SlidingContact& contact : sliding) wanted[static_cast<std::size_t>(contact.control)] = true;
  for (const SlippingMount& mount : mounts) {
    if (mount.feeds()) wanted[static_cast<std::size_t>(mount.control())] = true;
  }
  rod_->assemble(s, wanted, assembly_);
  take_reactions(s, at);
  rod_->hold_mounts(assembly_);
  add_contacts(s, at, system, by_parameter);
  std::swap(system.matrix, assembly_.hessian);
}

void PushSystem::assemble_residual(const numerics::PathPoint& at, numerics::BorderedSystem& system,
                                   Eigen::VectorXd& by_parameter) {
  const wire::PlanarState s = state(at);
  wire::assemble_gradient(*rod_, s, assembly_);
  take_reactions(s, at);
  rod_->clear_held(assembly_.gradient);
  add_contacts(s, at, system, by_parameter);
}

// From the gradient before rigid positions are held.
void PushSystem::take_reactions(const wire::PlanarState& s, const numerics::PathPoint& at) {
  const int last = 2 * rod_->mesh().edges();
  reactions_ = {assembly_.gradient.segment<2>(0), assembly_.gradient.segment<2>(last)};
  for (const wire::PlanarEnd* end : {&rod_->properties().left, &rod_->properties().right}) {
    // A mount that gives carries its force in the spring, which is part of the gradient.
    if (end->kind == wire::PlanarEnd::Kind::free || std::isinf(end->translational_stiffness)) continue;
    // By the wire's side of the balance: the spring of a stiff mount gives less than the last places of x can
    // show.
    const bool left = end == &rod_->properties().left;
    const double x = s.q[left ? 0 : last];
    reactions_[left ? 0 : 1].x() -= end->translational_stiffness * (x - end->position.x());
  }
  for (std::size_t k = 0; k < mounts.size(); ++k) {
    if (!mounts[k].feeds()) reactions_[mounts[k].right ? 1 : 0].x() = at.border[mount_row(k)];
  }
}

void PushSystem::add_contacts(const wire::PlanarState& s, const numerics::PathPoint& at,
                              numerics::BorderedSystem& system, Eigen::VectorXd& by_parameter) {
  const int m = border_unknowns();
  system.reset(rod_->unknowns(), m);
  by_parameter.setZero(m);
  system.band_residual = assembly_.gradient;
  for (std::size_t k = 0; k < sliding.size(); ++k) assemble_sliding(k, s, at, system, by_parameter);
  for (std::size_t k = 0; k < wrapped.size(); ++k) assemble_wrapped(k, s, at, system, by_parameter);
  for (std::size_t k = 0; k < mounts.size(); ++k) assemble_mount(k, at, system);
}

void PushSystem::assemble_sliding(std::size_t index, const wire::PlanarState& s,
                                  const numerics::PathPoint& at, numerics::BorderedSystem& system,
                                  Eigen::VectorXd& by_parameter) const {
  const SlidingContact& contact = sliding[index];
  const SlidingRows rows = sliding_rows(index);
  const int i = contact.node;
  const Vector2d force = at.border.segment<2>(rows.force);
  const double coordinate = at.border[rows.coordinate];
  const double gap = at.border[rows.gap];
  Eigen::MatrixXd& corner = system.corner;
  Eigen::VectorXd& residual = system.border_residual;

  system.columns.emplace_back(rows.coordinate,
                              &assembly_.control_columns[static_cast<std::size_t>(contact.control)]);
  const bool pressed = is_pressed(contact);
  const bool keeps = keeps_from_afar(contact);
  if (pressed || keeps) {
    // The rod's equilibrium: dE/dx_i - f = 0.
    system.band_residual.segment<2>(2 * i) -= force;
    for (int a = 0; a < 2; ++a) system.anchors.push_back({2 * i + a, rows.force + a});
  }
  if (contact.status == ContactStatus::wrapped) {
    // The arc is held by the wrapped contacts: f = 0; this vertex keeps its material coordinate.
    residual.segment<2>(rows.position) = force;
    for (int a = 0; a < 2; ++a) corner(rows.position + a, rows.force + a) = 1.0;
    residual[rows.slip] = coordinate - contact.last_coordinate;
    corner(rows.slip, rows.coordinate) = 1.0;
    residual[rows.closure] = gap;
    corner(rows.closure, rows.gap) = 1.0;
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
  const RowVector2d by_previous = -v.slope.before * by_u;
  const RowVector2d by_next = v.slope.after * by_u;
  const RowVector2d by_vertex = -by_previous - by_next;
  const wire::MaterialMesh& mesh = rod_->mesh();
  const auto by_control = [&](int control) {
    double sum = 0.0;
    if (i > 0) sum += by_u.dot(v.slope.by_before) * mesh.rest_length_derivative(i - 1, control);
    if (i < mesh.edges()) sum += by_u.dot(v.slope.by_after) * mesh.rest_length_derivative(i, control);
    return sum;
  };
  // Adds factor * d angle to a border equation.
  const auto add_angle = [&](int row, double factor) {
    for (int a = 0; a < 2; ++a) {
      if (i > 0) system.rows.push_back({row, 2 * (i - 1) + a, factor * by_previous[a]});
      system.rows.push_back({row, 2 * i + a, factor * by_vertex[a]});
      if (i < mesh.edges()) system.rows.push_back({row, 2 * (i + 1) + a, factor * by_next[a]});
    }
    for (std::size_t k = 0; k < sliding.size(); ++k) {
      corner(row, sliding_rows(k).coordinate) += factor * by_control(sliding[k].control);
    }
    for (std::size_t k = 0; k < mounts.size(); ++k) {
      if (mounts[k].feeds()) corner(row, mount_row(k)) += factor * by_control(mounts[k].control());
    }
  };

  // Position: x - p - (R + g) n = 0.                                                          theory.md (C.2)
  residual.segment<2>(rows.position) = wire::vertex(s, i) - centre - reach * n;
  for (int a = 0; a < 2; ++a) {
    const int row = rows.position + a;
    system.rows.push_back({row, 2 * i + a, 1.0});
    add_angle(row, -reach * dn[a]);
    corner(row, rows.gap) = touching ? -contact.approach()[a] : -n[a];
    by_parameter[row] = -contact.motion[a];
    if (index == 0) add_compliance(row, -Vector2d::Unit(a), system);
  }
  if (keeps) {
    // Apart, the material point kept: f.n = 0.                                                theory.md (C.3)
    residual[rows.slip] = coordinate - contact.last_coordinate;
    corner(rows.slip, rows.coordinate) = 1.0;
    residual[rows.closure] = force.dot(n);
    corner.block<1, 2>(rows.closure, rows.force) = n.transpose();
    add_angle(rows.closure, force.dot(dn));
    return;
  }
  if (!pressed) {
    // Apart: f = 0.                                                                           theory.md (C.3)
    residual.segment<2>(rows.slip) = force;
    corner(rows.slip, rows.force) = corner(rows.closure, rows.force + 1) = 1.0;
    return;
  }
  residual[rows.closure] = gap;
  corner(rows.closure, rows.gap) = 1.0;
  if (contact.holds_material && contact.friction == 0.0) {
    residual[rows.slip] = coordinate - contact.last_coordinate;
    corner(rows.slip, rows.coordinate) = 1.0;
  } else if (contact.holds_material || contact.status == ContactStatus::stick) {
    // Rolling: dS + side R d angle = 0.                                                       theory.md (C.5)
    residual[rows.slip] = coordinate - contact.last_coordinate +
                          contact.side * contact.radius * angle_between(contact.last_tangent, v.t);
    corner(rows.slip, rows.coordinate) = 1.0;
    add_angle(rows.slip, contact.side * contact.radius);
  } else {
    // Sliding: f.t - sign mu f.n = 0.                                                  theory.md (C.4), (C.5)
    const double limit = contact.slip_sign * contact.friction;
    residual[rows.slip] = force.dot(v.t) - limit * force.dot(n);
    corner(rows.slip, rows.force) = v.t.x() - limit * n.x();
    corner(rows.slip, rows.force + 1) = v.t.y() - limit * n.y();
    add_angle(rows.slip, force.dot(v.normal) - limit * force.dot(dn));
  }
}

// With n = (x - p)/|x - p| and tau = n turned left: |x - p| - R = 0, and along tau it sticks, R d angle = 0,
// or slides, f.tau + sign mu f.n = 0.                                                         theory.md (C.7)
void PushSystem::assemble_wrapped(std::size_t index, const wire::PlanarState& s,
                                  const numerics::PathPoint& at, numerics::BorderedSystem& system,
                                  Eigen::VectorXd& by_parameter) const {
  const WrappedContact& contact = wrapped[index];
  const SlidingContact& pusher = sliding.front();
  const WrappedRows rows = wrapped_rows(index);
  const int i = contact.node;
  const Vector2d force = at.border.segment<2>(rows.force);
  system.band_residual.segment<2>(2 * i) -= force;
  for (int a = 0; a < 2; ++a) system.anchors.push_back({2 * i + a, rows.force + a});

  const Vector2d arm = wire::vertex(s, i) - pusher_centre(at);
  const double distance = arm.norm();
  const Vector2d n = arm / distance;
  const Vector2d tau(-n.y(), n.x());  // of increasing angle about the centre
  Eigen::MatrixXd& corner = system.corner;

  system.border_residual[rows.distance] = distance - pusher.radius;
  by_parameter[rows.distance] = -n.dot(pusher.motion);
  double residual = 0.0;
  double by_angle = 0.0;  // d residual / d angle of n
  if (contact.status == ContactStatus::stick) {
    residual = pusher.radius * angle_between(contact.last_radial, n);
    by_angle = pusher.radius;
  } else {
    const double limit = -contact.slip_sign * contact.friction;
    residual = force.dot(tau) - limit * force.dot(n);
    corner(rows.slip, rows.force) = tau.x() - limit * n.x();
    corner(rows.slip, rows.force + 1) = tau.y() - limit * n.y();
    by_angle = -force.dot(n) - limit * force.dot(tau);
  }
  system.border_residual[rows.slip] = residual;
  by_parameter[rows.slip] = -by_angle * tau.dot(pusher.motion) / distance;
  add_compliance(rows.distance, -n, system);
  add_compliance(rows.slip, -by_angle / distance * tau, system);
  for (int a = 0; a < 2; ++a) {
    system.rows.push_back({rows.distance, 2 * i + a, n[a]});
    system.rows.push_back({rows.slip, 2 * i + a, by_angle * tau[a] / distance});
  }
}

// With the sense s from the mount inwards. Feeding: the unknown is S, the drive s dE/dS. Sliding: the unknown
// is the force f of the friction on the wire along the chord, the drive -s f, and the mount stands at x + c
// f, c its spring's compliance.
//   holds: S or x + c f as at the last state;   slips: drive = sign * limit                   theory.md (C.8)
void PushSystem::assemble_mount(std::size_t index, const numerics::PathPoint& at,
                                numerics::BorderedSystem& system) const {
  const SlippingMount& mount = mounts[index];
  const int row = mount_row(index);
  const double sense = mount.sense();
  if (!mount.feeds()) {
    const int x = band_of(mount);
    system.band_residual[x] -= at.border[row];
    system.anchors.push_back({x, row});
    if (mount.slips) {
      system.border_residual[row] = mount_drive(index, at) - mount.slip_sign * mount.limit;
      system.corner(row, row) = -sense;
      return;
    }
    system.border_residual[row] = mount_place(index, at) - mount.last;
    system.rows.push_back({row, x, 1.0});
    system.corner(row, row) = mount.compliance;
    return;
  }
  const auto control = static_cast<std::size_t>(mount.control());
  const Eigen::VectorXd& column = assembly_.control_columns[control];
  system.columns.emplace_back(row, &column);
  if (mount.follows) {
    const int first = mount_row(0);
    system.border_residual[row] = mount.moved(at.border[row]) - mounts.front().moved(at.border[first]);
    system.corner(row, row) = system.corner(row, first) = 1.0;
    return;
  }
  if (!mount.slips) {
    system.border_residual[row] = at.border[row] - mount.last;
    system.corner(row, row) = 1.0;
    return;
  }
  system.border_residual[row] = mount_drive(index, at) - mount.slip_sign * mount.limit;
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    if (column[i] != 0.0) system.rows.push_back({row, static_cast<int>(i), sense * column[i]});
  }
  for (std::size_t k = 0; k < mounts.size(); ++k) {
    if (!mounts[k].feeds()) continue;
    system.corner(row, mount_row(k)) =
        sense * assembly_.control_hessian(mount.control(), mounts[k].control());
  }
  for (std::size_t k = 0; k < sliding.size(); ++k) {
    system.corner(row, sliding_rows(k).coordinate) =
        sense * assembly_.control_hessian(mount.control(), sliding[k].control);
  }
}

double PushSystem::mount_drive(std::size_t k, const numerics::PathPoint& at) const {
  const SlippingMount& mount = mounts[k];
  return mount.sense() *
         (mount.feeds() ? assembly_.control_gradient[mount.control()] : -at.border[mount_row(k)]);
}

double PushSystem::mount_place(std::size_t k, const numerics::PathPoint& at) const {
  const double unknown = at.border[mount_row(k)];
  return mounts[k].feeds() ? unknown : at.band[band_of(mounts[k])] + mounts[k].compliance * unknown;
}

wire::PlanarRod PushSystem::rod_with_held_mounts(const numerics::PathPoint& at) const {
  wire::PlanarRodProperties held = rod_->properties();
  for (const SlippingMount& mount : mounts) {
    if (mount.feeds()) continue;
    wire::PlanarEnd& end = mount.right ? held.right : held.left;
    end.translational_stiffness = std::numeric_limits<double>::infinity();
    end.position.x() = at.band[band_of(mount)];
  }
  return {rod_->mesh(), held};
}

double PushSystem::error(const numerics::PathPoint& at, const numerics::BorderedSystem& system) const {
  const wire::PlanarRodProperties& p = rod_->properties();
  double largest = 0.0;
  for (std::size_t k = 0; k < sliding.size(); ++k) {
    largest = std::max(largest, at.border.segment<2>(sliding_rows(k).force).norm());
  }
  const double tension = std::max(reactions_[0].norm(), reactions_[1].norm());
  const auto [axial, bending] = wire::sticking_stiffness(p);
  const double force =
      wire::force_tolerance(1e-10, bending, axial, length_, shortest_edge_, std::max(largest, tension));
  const double position = 1e-12 * length_;
  const Eigen::VectorXd& residual = system.border_residual;
  const Eigen::Index right = 2 * rod_->mesh().edges();
  const Eigen::VectorXd& band = system.band_residual;
  double error = std::max(
      {std::abs(band[0]) / (force + wire::mount_round_off(p.left.translational_stiffness, length_)),
       std::abs(band[right]) / (force + wire::mount_round_off(p.right.translational_stiffness, length_)),
       band.segment(1, right - 1).lpNorm<Eigen::Infinity>() / force, std::abs(band[right + 1]) / force});
  for (std::size_t k = 0; k < sliding.size(); ++k) {
    const SlidingContact& contact = sliding[k];
    const SlidingRows rows = sliding_rows(k);
    const bool slides = contact.status == ContactStatus::slip && !contact.holds_material;
    const bool apart = contact.status == ContactStatus::open || contact.status == ContactStatus::touching;
    const bool on_arc = contact.status == ContactStatus::wrapped;
    error = std::max(
        error, residual.segment<2>(rows.position).lpNorm<Eigen::Infinity>() / (on_arc ? force : position));
    const bool slip_of_force = slides || (apart && !keeps_from_afar(contact));
    error = std::max(error, std::abs(residual[rows.slip]) / (slip_of_force ? force : position));
    error = std::max(error, std::abs(residual[rows.closure]) / (apart ? force : position));
  }
  for (std::size_t k = 0; k < wrapped.size(); ++k) {
    const WrappedRows rows = wrapped_rows(k);
    const bool slides = wrapped[k].status == ContactStatus::slip;
    error = std::max(error, std::abs(residual[rows.distance]) / position);
    error = std::max(error, std::abs(residual[rows.slip]) / (slides ? force : position));
  }
  for (std::size_t k = 0; k < mounts.size(); ++k) {
    error = std::max(error, std::abs(residual[mount_row(k)]) / (mounts[k].slips ? force : position));
  }
  return error;
}

}  // namespace snare::coupling
