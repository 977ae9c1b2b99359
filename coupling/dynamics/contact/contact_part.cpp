#include "coupling/dynamics/contact/contact_part.hpp"

#include "base/index.hpp"
#include "coupling/contact/curve.hpp"
#include "coupling/dynamics/contact/contact_integral.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace snare::coupling {

using Eigen::Vector2d;
using Eigen::Vector3d;
using multibody::Pose;
using numerics::DaeKind;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

// A law's minimum of the gap that is flatter than this along the wire [1/m] is taken to stand still.
//                                                                                             theory.md (G.9)
constexpr double least_curvature = 1.0;

// Beside what may be touched next, so that the pattern rarely changes.
constexpr int coupled_beside = 2;

}  // namespace

ContactPart::ContactPart(const MotionContact& contact, std::shared_ptr<const ContactShape> piece,
                         const wire::RodPart& rod, const BodyPart& body)
    : contact_(contact),
      rod_(rod),
      body_(body),
      search_(contact, std::move(piece), rod, body),
      coupled_(base::at(search_.curve().elements()), false) {
  assert(rod_.vertices() >= 5);
  const wire::SpatialRodProperties& p = rod_.constants().properties;
  const double diameter = 2.0 * contact_.wire_radius;
  if (contact_.foundation.modulus == 0.0)
    contact_.foundation.modulus = default_modulus(p.axial_stiffness, p.bending_stiffness, diameter);
  // A mount: EA over the length that gives way; friction by the smooth law with the one coefficient of
  // sliding.
  mount_length_ =
      mount_length(p.axial_stiffness, p.bending_stiffness, diameter, search_.shape().smallest_radius());
  mount_weight_ = p.axial_stiffness / (mount_length_ * contact_.foundation.modulus);
  at_mount_ = contact_;
  at_mount_.friction = MotionFriction{.static_coefficient = contact_.friction.dynamic_coefficient,
                                      .dynamic_coefficient = contact_.friction.dynamic_coefficient,
                                      .law = ContactFriction::smooth};
}

void ContactPart::declare(numerics::DaeLayout& layout) {
  if (!has_bristle()) return;
  // Outside of the error test: z is the integral of a sliding whose displacements are tested.
  bristle_ = layout.add({contact_.name + " bristle",
                         {"along", "across"},
                         2 * rod_.vertices(),
                         DaeKind::algebraic,
                         0.1 * contact_.friction.bristle_displacement,
                         0});
}

void ContactPart::attach_pattern(const numerics::SparseMatrix& pattern) {
  slots_.attach(pattern);
  if (found_.inputs.depends()) return;
  found_.inputs.depend_on(body_.position(), BodyPart::coordinates + BodyPart::velocities);
  found_.inputs.depend_on(rod_.position_of(0), 3 * rod_.vertices());
  found_.inputs.depend_on(rod_.velocity_of(0), 3 * rod_.vertices());
  if (has_bristle()) found_.inputs.depend_on(bristle_, 2 * rod_.vertices());
  accepted_ = AcceptedPress(found_.inputs);
}

std::vector<int> ContactPart::restrict_to_plane(int normal) {
  normal_ = normal;
  std::vector<int> unknowns;
  for (int i = 0; has_bristle() && i < rod_.vertices(); ++i) unknowns.push_back(bristle_of(i) + 1);
  return unknowns;
}

bool ContactPart::outgrows_pattern(const DaePoint& at) {
  const ContactCache& found = found_at(at.y);
  const auto known = [this](const QuadraturePoint& n) { return coupled_[base::at(n.element)]; };
  if (std::ranges::all_of(found.nodes, known)) return false;
  std::vector<bool> wanted(coupled_.size(), false);
  for (const int e : search_.candidates()) wanted[base::at(e)] = coupled_[base::at(e)];
  const int last = search_.curve().elements() - 1;
  for (const QuadraturePoint& n : found.nodes) {
    for (int k = std::max(0, n.element - coupled_beside); k <= std::min(last, n.element + coupled_beside);
         ++k)
      wanted[base::at(k)] = true;
  }
  coupled_ = std::move(wanted);
  return true;
}

void ContactPart::restore_state(const VectorView& y, std::span<const double>& /*memory*/) {
  std::fill(coupled_.begin(), coupled_.end(), false);
  update_candidates(y);
}

void ContactPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  if (has_bristle()) {
    for (int k = 0; k < 2 * rod_.vertices(); ++k) entries.emplace_back(bristle_ + k, bristle_ + k);
  }
  for (int e = 0; e < search_.curve().elements(); ++e) {
    if (!coupled_[base::at(e)]) continue;
    std::vector<int> columns, rows;
    const int first = search_.curve().first_vertex(e);
    for (int i = first; i < first + 4; ++i) {
      for (int a = 0; a < 3; ++a) {
        columns.push_back(rod_.position_of(i) + a);
        columns.push_back(rod_.velocity_of(i) + a);
        if (!rod_.is_held(i, a)) rows.push_back(rod_.velocity_of(i) + a);
      }
    }
    for (int k = 0; k < BodyPart::coordinates; ++k) columns.push_back(body_.position() + k);
    for (int k = 0; k < BodyPart::velocities; ++k) {
      columns.push_back(body_.velocity() + k);
      if (body_.moves_freely()) rows.push_back(body_.velocity() + k);
    }
    for (int k = 0; has_bristle() && k < 4; ++k) {
      columns.push_back(bristle_of(e) + k);
      rows.push_back(bristle_of(e) + k);
    }
    for (const int row : rows) {
      for (const int column : columns) entries.emplace_back(row, column);
    }
  }
}

ContactPart::QuadraturePoint ContactPart::node(int element, double u, double weight) const {
  const BezierWire& curve = search_.curve();
  QuadraturePoint n;
  n.element = element;
  n.u = u;
  n.weight = weight;
  n.first = curve.first_vertex(element);
  n.value = curve.value(element, u);
  n.slope = curve.slope(element, u);
  n.bend.setZero();
  n.shape_functions = {1.0 - u, u};
  return n;
}

bool ContactPart::stops(wire::End end) const {
  if (rod_.is_carried(end)) return true;
  const int vertex = end == wire::End::left ? 0 : rod_.vertices() - 1;
  return rod_.is_held(vertex, 0) && rod_.is_held(vertex, 1) && rod_.is_held(vertex, 2);
}

// x^2 (3 - 2 x) of the way from a mount to the end of the piece that gives way.
double ContactPart::foundation_share(double coordinate) const {
  const BezierWire& curve = search_.curve();
  const int last = curve.elements() - 1;
  double share = 1.0;
  const auto fade = [&](wire::End end, double way) {
    if (way >= mount_length_ || !stops(end)) return;
    const double x = way / mount_length_;
    share *= x * x * (3.0 - 2.0 * x);
  };
  fade(wire::End::left, coordinate);
  fade(wire::End::right, curve.begin(last) + curve.length(last) - coordinate);
  return share;
}

void ContactPart::add_stretch(int e, const ContactInterval& s, std::size_t index,
                              std::vector<QuadraturePoint>& nodes) const {
  const BezierWire& curve = search_.curve();
  const double length = curve.length(e);
  const auto add = [&](const QuadraturePoint& n) {
    nodes.push_back(n);
    nodes.back().stretch = index;
  };
  for_each_place(s, [&](double u, double weight) {
    add(node(e, u, weight * length * foundation_share(curve.begin(e) + u * length)));
  });
  const auto mount = [&](double u) {
    QuadraturePoint n = node(e, u, mount_weight_);
    n.place = ContactPlace::mount;
    n.shape_functions = {};
    add(n);
  };
  if (e == 0 && s.from == 0.0 && stops(wire::End::left)) mount(0.0);
  if (e + 1 == curve.elements() && s.to == 1.0 && stops(wire::End::right)) mount(1.0);
}

void ContactPart::find(const VectorView& y, ContactCache& found) const {
  const Pose where = search_.X_WS(y);
  const BezierWire& curve = search_.curve();
  for (const int e : search_.candidates()) {
    const BezierWire::Control c = search_.control(where, e, y);
    if (search_.lower_bound(c) > 0.0) continue;
    const double length = curve.length(e);
    const auto gap = [&](double u) {
      const DistanceField field = search_.shape().at(c * bernstein(u));
      const Vector3d slope = c * bernstein_slope(u) / length;
      return GapPlace{u, field.distance - contact_.wire_radius, field.normal.dot(slope),
                      std::max(0.0, -slope.dot(field.hessian * slope))};
    };
    const double way = (c.rightCols<3>() - c.leftCols<3>()).colwise().norm().sum();
    found.minima.clear();
    const std::size_t before = found.stretches.size();
    const GapPlace begin = gap(0.0), end = gap(1.0);
    ContactIntervals(length, way, largest_bend(c) / (length * length), search_.resolution())
        .find(gap, begin, end, found.stretches, found.minima);
    found.elements.resize(found.stretches.size(), e);
    if (has_law()) {
      if (e == 0 && begin.gap < 0.0 && begin.slope >= 0.0) found.minima.push_back(begin);
      if (e + 1 == curve.elements() && end.gap < 0.0 && end.slope < 0.0) found.minima.push_back(end);
      for (const GapPlace& m : found.minima) {
        QuadraturePoint n = node(e, m.u, 1.0);
        n.bend = curve_weights(rod_, curve.begin(e) + m.u * length).bend;
        n.follows = m.u > 0.0 && m.u < 1.0;
        found.nodes.push_back(n);
      }
      continue;
    }
    for (std::size_t k = before; k < found.stretches.size(); ++k)
      add_stretch(e, found.stretches[k], k, found.nodes);
  }
}

ContactGeometry ContactPart::geometry(const QuadraturePoint& n, const VectorView& y) const {
  CurvePoint curve;
  for (int k = 0; k < 4; ++k) {
    const Vector3d x = y.segment<3>(rod_.position_of(n.first + k));
    const Vector3d v = y.segment<3>(rod_.velocity_of(n.first + k));
    curve.x += n.value[k] * x;
    curve.slope += n.slope[k] * x;
    curve.bend += n.bend[k] * x;
    curve.v += n.value[k] * v;
    curve.slope_v += n.slope[k] * v;
  }
  BristlesBeside beside;
  beside.shape_functions = n.shape_functions;
  for (int h = 0; has_bristle() && h < 2; ++h)
    beside.bristles[base::at(h)] = y.segment<2>(bristle_of(n.element + h));
  const MotionContact& contact = n.place == ContactPlace::mount ? at_mount_ : contact_;
  return contact_geometry(contact, search_.shape(), curve, body_, y, beside, n.place);
}

BristleState ContactPart::bristle_state(const QuadraturePoint& n, std::size_t h, const ContactGeometry& g,
                                        const VectorView& y) const {
  BristleState at = g.state;
  at.bristle = y.segment<2>(bristle_of(n.element + static_cast<int>(h)));
  return at;
}

BristleFlow ContactPart::bristle_flow_at(const QuadraturePoint& n, std::size_t h, const ContactGeometry& g,
                                         const VectorView& y) const {
  return bristle_flow(contact_.friction, bristle_state(n, h, g, y), g.of_bristles[h], g.elastic_rate());
}

// Residual and Jacobian, sums and samples are of the same places again and again.
const ContactPart::ContactCache& ContactPart::found_at(const VectorView& y) const {
  if (found_.inputs.holds(y)) return found_;
  found_.inputs.take(y);
  found_.nodes.clear();
  found_.stretches.clear();
  found_.elements.clear();
  found_.geometries.clear();
  if (!search_.candidates().empty()) find(y, found_);
  for (const QuadraturePoint& n : found_.nodes) found_.geometries.push_back(geometry(n, y));
  if (has_bristle()) add_up_bristles(y, found_);
  return found_;
}

void ContactPart::accept(const DaePoint& at) {
  search_.update(at.y);
  accepted_.take(at.y, [this](const VectorView& y) -> const ContactCache& { return found_at(y); });
}

numerics::IterationStart ContactPart::iteration_start(const VectorView& from, const VectorView& to) {
  if (has_law()) return {};
  return accepted_.start(
      from, to, rod_.tolerances().position,
      [this](const VectorView& y) -> const ContactCache& { return found_at(y); },
      [this](const VectorView& y) { return search_.nearest(y).gap; });
}

void ContactPart::add_up_bristles(const VectorView& y, ContactCache& found) const {
  found.bristles.begin(rod_.vertices());
  for (std::size_t q = 0; q < found.nodes.size(); ++q) {
    const QuadraturePoint& n = found.nodes[q];
    const ContactGeometry& g = found.geometries[q];
    for (std::size_t h = 0; h < 2 && n.place == ContactPlace::wire; ++h) {
      const double share = n.weight * n.shape_functions[h];
      found.bristles.add(n.element + static_cast<int>(h), share * g.state.elastic,
                         share * bristle_flow_at(n, h, g, y).flow);
    }
  }
  found.bristles.finish(y.segment(bristle_, 2 * rod_.vertices()), contact_.friction.bristle_time);
}

void ContactPart::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  const ContactCache& found = found_at(at.y);
  for (std::size_t q = 0; q < found.nodes.size(); ++q) {
    const QuadraturePoint& n = found.nodes[q];
    const ContactGeometry& g = found.geometries[q];
    const Vector3d force = n.weight * g.force;
    // The wire: m v_k' + ... - N_k f = 0, but for components that a mount holds.
    for (int k = 0; k < 4; ++k) {
      for (int a = 0; a < 3; ++a) {
        if (!rod_.is_held(n.first + k, a)) rows[rod_.velocity_of(n.first + k) + a] -= n.value[k] * force[a];
      }
    }
    // The body: inertia less forces, + f in the world and + R^T (r x f) in the body.
    if (body_.moves_freely()) {
      rows.segment<3>(body_.velocity()) += force;
      rows.segment<3>(body_.spin()) += g.R_WB.transpose() * g.arm.cross(force);
    }
  }
  if (!has_bristle()) return;
  const int count = 2 * rod_.vertices();
  rows.segment(bristle_, count) += at.rate.segment(bristle_, count) - found.bristles.rates.reshaped();
}

void ContactPart::jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  const numerics::PatternValues into(slots_, values);
  const ContactCache& found = found_at(at.y);
  if (has_bristle()) {
    for (int i = 0; i < rod_.vertices(); ++i) {
      for (int a = 0; a < 2; ++a)
        into.add(bristle_of(i) + a, bristle_of(i) + a, c + found.bristles.forgetting(i));
    }
  }
  // The nodes of an element are behind each other.
  for (std::size_t q = 0; q < found.nodes.size();) {
    const int element = found.nodes[q].element;
    derivatives_.setZero();
    for (; q < found.nodes.size() && found.nodes[q].element == element; ++q)
      add_node_derivatives(found.nodes[q], found.geometries[q], found.bristles, at.y);
    for (std::size_t k = 0; has_bristle() && !has_law() && k < found.stretches.size(); ++k) {
      if (found.elements[k] != element) continue;
      for (const double u : {found.stretches[k].from, found.stretches[k].to}) {
        if (u > 0.0 && u < 1.0) add_end_derivatives(element, u, found.bristles, at.y);
      }
    }
    put_derivatives(element, into);
  }
}

// One direction after another: what changes along it in all rows, and from there to the unknowns that it
// belongs to.
void ContactPart::add_node_derivatives(const QuadraturePoint& n, const ContactGeometry& g,
                                       const BristleMeans& means, const VectorView& y) {
  const MotionFriction& friction = n.place == ContactPlace::mount ? at_mount_.friction : contact_.friction;
  // A law's minimum follows the tangency n.X' = 0.
  ContactDirection along;
  along.zeta = 1.0;
  const double curvature = n.follows ? contact_change(friction, g, along).tangency : 0.0;
  const bool has_flows = has_bristle() && n.place == ContactPlace::wire;
  std::array<BristleFlow, 2> flows;
  for (std::size_t h = 0; has_flows && h < 2; ++h) flows[h] = bristle_flow_at(n, h, g, y);
  // Wire and body: -d(N_k f) with dN_k = N_k' dzeta, + df, and -dm for the torque m on the body.
  const auto change = [&](ContactDirection d) {
    if (curvature >= least_curvature) d.zeta = -contact_change(friction, g, d).tangency / curvature;
    const ContactChange by = contact_change(friction, g, d);
    DerivativeRows rows;
    for (int k = 0; k < 4; ++k)
      rows.segment<3>(3 * k) = -n.weight * (n.value[k] * by.force + n.slope[k] * d.zeta * g.force);
    rows.segment<3>(body_rows) = n.weight * by.force;
    rows.segment<3>(body_rows + 3) = -n.weight * by.torque;
    rows.tail<4>().setZero();
    for (std::size_t h = 0; has_flows && h < 2; ++h) {
      const double share = n.weight * n.shape_functions[h];
      const BristleChange of{d.bristles[h], by.sliding, by.load, by.elastic, by.elastic_rate};
      const Vector2d flow = flow_change(friction, bristle_state(n, h, g, y), g.of_bristles[h], flows[h], of);
      rows.segment<2>(bristle_rows + 2 * static_cast<Eigen::Index>(h)) =
          means.change(n.element + static_cast<int>(h), share * by.elastic, share * flow);
    }
    return rows;
  };
  // Vertices: by N_k and N_k' of their places, by N_k of their velocities.
  for (int a = 0; a < 3; ++a) {
    if (!moves_along(a)) continue;
    ContactDirection place, slope, velocity, body_place, body_velocity;
    place.x = slope.slope = velocity.v = body_place.p = body_velocity.body_velocity = Vector3d::Unit(a);
    const DerivativeRows by_place = change(place), by_slope = change(slope), by_velocity = change(velocity);
    for (int k = 0; k < 4; ++k) {
      derivatives_.col(3 * k + a) += n.value[k] * by_place + n.slope[k] * by_slope;
      derivatives_.col(velocity_columns + 3 * k + a) += n.value[k] * by_velocity;
    }
    derivatives_.col(body_columns + a) += change(body_place);
    derivatives_.col(body_rate_columns + a) += change(body_velocity);
  }
  // dq turns the body by 4 R Q^T dq in the world.
  const Eigen::Matrix<double, 3, 4> turn =
      4.0 * g.R_WB * multibody::quaternion_rates(y.segment<4>(body_.quaternion())).transpose();
  for (int a = 0; a < 3; ++a) {
    if (!turns_about(a)) continue;
    ContactDirection turning, spin;
    turning.turn = spin.spin = Vector3d::Unit(a);
    const DerivativeRows by_turn = change(turning);
    for (int k = 0; k < 4; ++k) derivatives_.col(body_columns + 3 + k) += turn(a, k) * by_turn;
    derivatives_.col(body_rate_columns + 3 + a) += change(spin);
  }
  for (std::size_t h = 0; has_flows && h < 2; ++h) {
    for (int a = 0; a < (normal_ ? 1 : 2); ++a) {
      ContactDirection d;
      d.bristles[h] = Vector2d::Unit(a);
      derivatives_.col(bristle_columns + 2 * static_cast<Eigen::Index>(h) + a) += change(d);
    }
  }
}

// The ends of a stretch follow the zeros of the gap: d int G z/2 dS = (int of the derivative) - (G z/2)
// dg/|dg/dS| at each end.
void ContactPart::add_end_derivatives(int element, double u, const BristleMeans& means, const VectorView& y) {
  const QuadraturePoint n = node(
      element, u, foundation_share(search_.curve().begin(element) + u * search_.curve().length(element)));
  const ContactGeometry g = geometry(n, y);
  const double growth = std::max(-contact_.foundation.modulus * g.gap_rate, 0.0),
               steep = std::abs(g.normal.dot(g.slope));
  if (growth == 0.0 || steep < 1e-12) return;
  Eigen::Vector4d by_bristles;  // rows of the bristles by the gap
  for (int h = 0; h < 2; ++h) {
    const Vector2d flow = 0.5 * growth / steep * n.weight * n.shape_functions[base::at(h)] *
                          y.segment<2>(bristle_of(element + h));
    by_bristles.segment<2>(2 * h) = means.change(element + h, 0.0, flow);
  }
  // dg = n.(dX - dp - phi x r), phi = 4 R Q^T dq.
  const Eigen::RowVector3d by_turn = -g.arm.cross(g.normal).transpose();
  const Eigen::RowVector4d by_quaternion =
      4.0 * by_turn * g.R_WB * multibody::quaternion_rates(y.segment<4>(body_.quaternion())).transpose();
  for (int a = 0; a < 3; ++a) {
    if (!moves_along(a)) continue;
    for (int k = 0; k < 4; ++k)
      derivatives_.col(3 * k + a).tail<4>() += n.value[k] * g.normal[a] * by_bristles;
    derivatives_.col(body_columns + a).tail<4>() -= g.normal[a] * by_bristles;
  }
  for (int k = 0; k < 4; ++k)
    derivatives_.col(body_columns + 3 + k).tail<4>() += by_quaternion[k] * by_bristles;
}

void ContactPart::put_derivatives(int element, const numerics::PatternValues& into) const {
  const int first = search_.curve().first_vertex(element);
  const auto moves = [&](int k) { return moves_along(k % 3) && !rod_.is_held(first + k / 3, k % 3); };
  bool all = true;
  for (int k = 0; k < 12; ++k) all = all && moves(k);
  const auto put = [&](int unknown, int column) {
    const auto rows = derivatives_.col(column);
    if (all) into.add(rod_.velocity_of(first), unknown, rows.head<12>());
    for (int k = 0; !all && k < 12; ++k) {
      if (moves(k)) into.add(rod_.velocity_of(first) + k, unknown, rows[k]);
    }
    if (body_.moves_freely()) {
      into.add(body_.velocity(), unknown, rows.segment<3>(body_rows));
      into.add(body_.spin(), unknown, rows.segment<3>(body_rows + 3));
    }
    if (has_bristle()) into.add(bristle_of(element), unknown, rows.tail<4>());
  };
  for (int k = 0; k < 12; ++k) {
    if (!moves_along(k % 3)) continue;
    put(rod_.position_of(first) + k, k);
    put(rod_.velocity_of(first) + k, velocity_columns + k);
  }
  // Unknowns of a body that are held are left out of the pattern.
  for (int k = 0; k < BodyPart::coordinates; ++k) put(body_.position() + k, body_columns + k);
  for (int k = 0; k < BodyPart::velocities; ++k) put(body_.velocity() + k, body_rate_columns + k);
  for (int k = 0; has_bristle() && k < 4; ++k) put(bristle_of(element) + k, bristle_columns + k);
}

ContactPart::Sums ContactPart::sums(const VectorView& y) const {
  Sums s;
  const ContactCache& found = found_at(y);
  for (std::size_t q = 0; q < found.nodes.size(); ++q) {
    const QuadraturePoint& n = found.nodes[q];
    const ContactGeometry& g = found.geometries[q];
    const Vector3d force = n.weight * g.force;
    s.force += force;
    s.normal += n.weight * g.state.normal;
    s.moment += g.x.cross(force);
    // What the pair of forces takes from wire and body together, less what foundation or law and bristles
    // store.
    const double damped = (g.elastic[0] - g.state.normal) * g.gap_rate;
    double rubbed = g.friction.force.dot(g.state.sliding);
    if (has_bristle() && n.place == ContactPlace::wire) {
      rubbed = 0.0;
      for (std::size_t h = 0; h < 2; ++h) rubbed += n.shape_functions[h] * bristle_flow_at(n, h, g, y).heat;
    }
    s.lost_power += n.weight * (damped + rubbed);
    s.energy += n.weight * (has_law() ? contact_.law.energy(-g.gap) : contact_.foundation.energy(g.gap));
    s.body_power += force.dot(g.body_velocity + g.omega.cross(g.arm));
    for (int k = 0; k < 4; ++k) {
      const int i = n.first + k;
      if (i != 0 && i != rod_.vertices() - 1) continue;
      for (int a = 0; a < 3; ++a) {
        if (rod_.is_held(i, a)) s.on_mounts[i == 0 ? 0 : 1][a] += n.value[k] * force[a];
      }
    }
  }
  if (!has_bristle()) return s;
  const BristleMeans::Held held =
      found.bristles.held(contact_.friction, y.segment(bristle_, 2 * rod_.vertices()));
  s.energy += held.energy;
  s.lost_power += held.heat;
  return s;
}

std::pair<double, double> ContactPart::gap_at(const VectorView& y, double coordinate) const {
  const BezierWire& curve = search_.curve();
  const int e = curve.element_at(coordinate);
  const ContactGeometry g =
      geometry(node(e, std::clamp((coordinate - curve.begin(e)) / curve.length(e), 0.0, 1.0), 1.0), y);
  return {g.gap, g.gap_rate};
}

void ContactPart::set_bristle_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const {
  if (!has_bristle()) return;
  rate.segment(bristle_, 2 * rod_.vertices()) = found_at(y).bristles.rates.reshaped();
}

std::vector<ContactSample> ContactPart::samples(const VectorView& y) const {
  std::vector<ContactSample> list;
  const ContactCache& found = found_at(y);
  const BezierWire& curve = search_.curve();
  // One after another along the wire; a stretch that continues in the next element is one with it.
  double reached = -1.0;
  std::vector<std::size_t> of_stretch;
  for (std::size_t k = 0; k < found.stretches.size(); ++k) {
    const int e = found.elements[k];
    const ContactInterval& s = found.stretches[k];
    const double from = curve.begin(e) + s.from * curve.length(e);
    if (list.empty() || from > reached + 1e-9 * curve.longest()) {
      list.emplace_back();
      list.back().closed = true;
    }
    reached = curve.begin(e) + s.to * curve.length(e);
    of_stretch.push_back(list.size() - 1);
    list.back().gap = std::min(list.back().gap, s.deepest.gap);
  }
  for (std::size_t q = 0; q < found.nodes.size(); ++q) {
    const QuadraturePoint& n = found.nodes[q];
    const ContactGeometry& g = found.geometries[q];
    const auto owner = has_law() ? std::find(found.elements.begin(), found.elements.end(), n.element) -
                                       found.elements.begin()
                                 : static_cast<std::ptrdiff_t>(n.stretch);
    if (of_stretch.empty()) break;
    ContactSample& s = list[of_stretch[std::min(static_cast<std::size_t>(owner), of_stretch.size() - 1)]];
    const double normal = n.weight * g.state.normal;
    s.force += n.weight * g.force;
    s.normal_force += normal;
    s.point += normal * g.x;
    s.arc += normal * (curve.begin(n.element) + n.u * curve.length(n.element));
    s.slip_speed += normal * g.state.sliding.norm();
    if (!has_bristle() || n.place == ContactPlace::mount) continue;
    // The slider of what sticks stands still.
    if (g.of_bristles[n.shape_functions[1] > n.shape_functions[0] ? 1 : 0].slider_speed <= standing)
      s.sticking = true;
  }
  std::erase_if(list, [](const ContactSample& s) { return s.normal_force <= 0.0; });
  for (ContactSample& s : list) {
    s.point /= s.normal_force;
    s.arc /= s.normal_force;
    s.slip_speed /= s.normal_force;
  }
  return list;
}

}  // namespace snare::coupling
