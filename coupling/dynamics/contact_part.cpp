#include "coupling/dynamics/contact_part.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using numerics::DaeKind;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

constexpr int window_size =
    10;  // vertices in the pattern, more than the four of the curve so that it seldom changes

// Of a stabilising multiplier: its round-off grows as one over the step, and what it does to others is tested there.
constexpr double no_tolerance = 1e6;

// Below this curvature of the gap along the wire [1/m] its minimum is none: a radius of relative curvature of a metre, beyond
// any shape that wires meet.
constexpr double least_curvature = 1.0;

// Of a wire that lies flat the gap differs by less than this between a point and the next vertex [m].
constexpr double level_gap = 1e-12;

// n.X' below this is round-off.
constexpr double level_slope = 1e-9;

/// Weights of the slope of the curve at vertex i on the vertices i-1, i, i+1 (at an end on the three nearest).
struct SlopeWeights {
  int first;
  Vector3d weight;
};

SlopeWeights slope_weights(const wire::RodPart& rod, int i) {
  const int last = rod.vertices() - 1;
  const int middle = std::clamp(i, 1, last - 1);
  const double h0 = rod.coordinate(middle) - rod.coordinate(middle - 1);
  const double h1 = rod.coordinate(middle + 1) - rod.coordinate(middle);
  const double a = h1 / (h0 * (h0 + h1));
  const double b = h0 / (h1 * (h0 + h1));
  const Vector3d at_middle(-a, a - b, b);
  if (i == middle) return {middle - 1, at_middle};
  // The parabola's slope at its end: twice that of the chord less that at the middle.
  if (i < middle) return {0, 2.0 / h0 * Vector3d(-1.0, 1.0, 0.0) - at_middle};
  return {middle - 1, 2.0 / h1 * Vector3d(0.0, -1.0, 1.0) - at_middle};
}

}  // namespace

CurveWeights curve_weights(const wire::RodPart& rod, double coordinate) {
  const int last = rod.vertices() - 1;
  int e = 0;
  {
    int high = last;
    while (high - e > 1) {
      const int middle = (e + high) / 2;
      (rod.coordinate(middle) <= coordinate ? e : high) = middle;
    }
  }
  const double from = rod.coordinate(e);
  const double h = rod.coordinate(e + 1) - from;
  const double u = (coordinate - from) / h;
  CurveWeights w;
  w.first = std::clamp(e - 1, 0, last - 3);
  w.value.setZero();
  w.slope.setZero();
  w.bend.setZero();
  const auto add = [&](int vertex, double value, double slope, double bend) {
    w.value[vertex - w.first] += value;
    w.slope[vertex - w.first] += slope / h;
    w.bend[vertex - w.first] += bend / (h * h);
  };
  add(e, (1.0 + 2.0 * u) * (1.0 - u) * (1.0 - u), 6.0 * u * (u - 1.0), 12.0 * u - 6.0);
  add(e + 1, u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u), 6.0 - 12.0 * u);
  const auto add_slope = [&](int vertex, double value, double slope, double bend) {
    const SlopeWeights m = slope_weights(rod, vertex);
    for (int k = 0; k < 3; ++k)
      add(m.first + k, value * h * m.weight[k], slope * h * m.weight[k], bend * h * m.weight[k]);
  };
  add_slope(e, u * (1.0 - u) * (1.0 - u), (1.0 - u) * (1.0 - 3.0 * u), 6.0 * u - 4.0);
  add_slope(e + 1, u * u * (u - 1.0), u * (3.0 * u - 2.0), 6.0 * u - 2.0);
  return w;
}

struct ContactPart::Geometry {
  CurveWeights weights;
  Vector3d x, slope, bend, v, slope_v;  // X, X', X'', sum N v, sum N' v
  Matrix3d r_wb;
  Vector3d arm;      // X - p_WB
  Vector3d normal;   // world
  Matrix3d hessian;  // world
  double gap = 0.0;
  Vector3d omega, body_velocity, relative;  // relative: wire less body at X
  double gap_rate = 0.0;
  Vector3d along, across;  // axes a, b of the tangent plane
  double run = 0.0;        // length of X' in it
  BristleState state;
  double mu = 0.0;
  TangentForce friction;
  Vector3d force;  // on the wire
  [[nodiscard]] Vector3d in_world(const Vector2d& u) const { return u.x() * along + u.y() * across; }
};

/// Changes of: vertices (through the weights), body, multipliers.
struct ContactPart::Direction {
  Vector3d x = Vector3d::Zero(), slope = Vector3d::Zero(), v = Vector3d::Zero();
  Vector3d p = Vector3d::Zero(), turn = Vector3d::Zero(), body_velocity = Vector3d::Zero(),
           spin = Vector3d::Zero();
  double zeta = 0.0, lambda = 0.0;
  Vector2d bristle = Vector2d::Zero();
};

struct ContactPart::Change {
  double gap = 0.0, tangency = 0.0, gap_rate = 0.0;
  Vector2d sliding = Vector2d::Zero(), friction = Vector2d::Zero();
  Vector3d normal = Vector3d::Zero(), force = Vector3d::Zero(),
           torque = Vector3d::Zero();  // torque in B on the body
};

ContactPart::ContactPart(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body,
                         const MotionOptions& options)
    : contact_(contact), rod_(rod), body_(body), options_(options) {
  assert(contact.shape && rod.vertices() >= 5);
}

void ContactPart::declare(numerics::DaeLayout& layout) {
  first_ = layout.add(
      {contact_.name + " material coordinate", {}, 1, DaeKind::algebraic, options_.position_tolerance, 0});
  layout.add({contact_.name + " normal force", {}, 1, DaeKind::algebraic, options_.force_tolerance, 0});
  layout.add({contact_.name + " stabiliser", {}, 1, DaeKind::algebraic, no_tolerance, 0});
  // A hundredth of what it gives before it slips.
  if (has_bristle()) {
    layout.add({contact_.name + " bristle", {"along", "across"}, 2, DaeKind::differential,
                0.01 * contact_.friction.bristle_displacement, 0});
  }
}

std::vector<int> ContactPart::local_unknowns(int first_vertex) const {
  std::vector<int> list;
  const int end = std::min(rod_.vertices(), first_vertex + window_size);
  for (int i = first_vertex; i < end; ++i) {
    for (int k = 0; k < 3; ++k) list.push_back(rod_.position_of(i) + k);
    for (int k = 0; k < 3; ++k) list.push_back(rod_.velocity_of(i) + k);
  }
  for (int k = 0; k < 13; ++k) list.push_back(body_.position() + k);
  for (int k = 0; k < own_unknowns(); ++k) list.push_back(first_ + k);
  return list;
}

void ContactPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  for (int k = 0; k < own_unknowns(); ++k) entries.emplace_back(first_ + k, first_ + k);
  if (!coupled_) return;
  const std::vector<int> all = local_unknowns(window_);
  const int end = std::min(rod_.vertices(), window_ + window_size);
  const auto whole_row = [&](int row) {
    for (const int column : all) entries.emplace_back(row, column);
  };
  for (int i = window_; i < end; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (rod_.is_held(i, k)) continue;
      whole_row(rod_.velocity_of(i) + k);
      entries.emplace_back(rod_.position_of(i) + k, stabiliser_unknown());
    }
  }
  if (body_.moves_freely()) {
    for (int k = 0; k < 6; ++k) whole_row(body_.velocity() + k);
  }
  for (int k = 0; k < own_unknowns(); ++k) whole_row(first_ + k);
}

void ContactPart::attach_pattern(const numerics::SparseMatrix& pattern) {
  pattern_ = &pattern;
}

ContactPart::Geometry ContactPart::geometry(const VectorView& y) const {
  Geometry g;
  g.weights = curve_weights(rod_, std::clamp(y[first_], 0.0, rod_.coordinate(rod_.vertices() - 1)));
  g.x = g.slope = g.bend = g.v = g.slope_v = Vector3d::Zero();
  for (int k = 0; k < 4; ++k) {
    const Vector3d x = y.segment<3>(rod_.position_of(g.weights.first + k));
    const Vector3d v = y.segment<3>(rod_.velocity_of(g.weights.first + k));
    g.x += g.weights.value[k] * x;
    g.slope += g.weights.slope[k] * x;
    g.bend += g.weights.bend[k] * x;
    g.v += g.weights.value[k] * v;
    g.slope_v += g.weights.slope[k] * v;
  }
  const Vector4d q = y.segment<4>(body_.quaternion());
  g.r_wb = multibody::rotation(q);
  g.arm = g.x - y.segment<3>(body_.position());
  const Matrix3d r_ws = g.r_wb * contact_.shape_rotation;
  const Vector3d in_shape = r_ws.transpose() * (g.arm - g.r_wb * contact_.shape_position);
  const DistanceField field = contact_.shape->at(in_shape);
  g.gap = field.distance - contact_.wire_radius;
  g.normal = r_ws * field.normal;
  g.hessian = r_ws * field.hessian * r_ws.transpose();
  g.omega = g.r_wb * y.segment<3>(body_.spin());
  g.body_velocity = y.segment<3>(body_.velocity());
  g.relative = g.v - g.body_velocity - g.omega.cross(g.arm);
  g.gap_rate = g.normal.dot(g.relative);
  const Vector3d level = g.slope - g.normal.dot(g.slope) * g.normal;
  g.run = level.norm();
  g.along = level / g.run;
  g.across = g.normal.cross(g.along);
  g.state.sliding = {g.along.dot(g.relative), g.across.dot(g.relative)};
  g.state.normal = y[force_unknown()];
  if (has_bristle()) g.state.bristle = y.segment<2>(bristle_unknown());
  g.mu = y[stabiliser_unknown()];
  g.friction = tangent_force(contact_.friction, mode_, g.state);
  g.force = g.state.normal * g.normal - g.in_world(g.friction.force);
  return g;
}

// In the body the wire's point moves by rho = dX - dp - turn x arm; then d gap = n.rho, dn = H rho + turn x n.
ContactPart::Change ContactPart::change(const Geometry& g, const Direction& d) const {
  Change c;
  const Vector3d dx = d.x + g.slope * d.zeta;
  const Vector3d dslope = d.slope + g.bend * d.zeta;
  const Vector3d darm = dx - d.p;
  const Vector3d rho = darm - d.turn.cross(g.arm);
  c.normal = g.hessian * rho + d.turn.cross(g.normal);
  c.gap = g.normal.dot(rho);
  c.tangency = g.slope.dot(c.normal) + g.normal.dot(dslope);
  const Vector3d domega = d.turn.cross(g.omega) + g.r_wb * d.spin;
  const Vector3d drelative =
      d.v + g.slope_v * d.zeta - d.body_velocity - domega.cross(g.arm) - g.omega.cross(darm);
  c.gap_rate = g.relative.dot(c.normal) + g.normal.dot(drelative);
  c.force = d.lambda * g.normal + g.state.normal * c.normal;
  if (contact_.friction.acts()) {
    // The axes turn with X' and n: |u| da = du - a (a.du) for u = X' less its normal part.
    const Vector3d du = dslope - (c.normal.dot(g.slope) + g.normal.dot(dslope)) * g.normal -
                        g.normal.dot(g.slope) * c.normal;
    const Vector3d dalong = (du - g.along.dot(du) * g.along) / g.run;
    const Vector3d dacross = c.normal.cross(g.along) + g.normal.cross(dalong);
    c.sliding = {dalong.dot(g.relative) + g.along.dot(drelative), dacross.dot(g.relative) + g.across.dot(drelative)};
    c.friction = g.friction.by_bristle * d.bristle + g.friction.by_sliding * c.sliding + g.friction.by_normal * d.lambda;
    c.force -= g.in_world(c.friction) + g.friction.force.x() * dalong + g.friction.force.y() * dacross;
  }
  const Vector3d moment = -g.arm.cross(g.force);
  const Vector3d dmoment = -darm.cross(g.force) - g.arm.cross(c.force);
  c.torque = g.r_wb.transpose() * (dmoment - d.turn.cross(moment));
  return c;
}

void ContactPart::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  if (!closed_) {
    rows[first_] += at.y[first_] - kept_coordinate_;
    rows[force_unknown()] += at.y[force_unknown()];
    rows[stabiliser_unknown()] += at.y[stabiliser_unknown()];
    if (has_bristle()) rows.segment<2>(bristle_unknown()) += at.y.segment<2>(bristle_unknown());
    return;
  }
  const Geometry g = geometry(at.y);
  for (int k = 0; k < 4; ++k) {
    const int i = g.weights.first + k;
    for (int a = 0; a < 3; ++a) {
      if (rod_.is_held(i, a)) continue;
      rows[rod_.velocity_of(i) + a] -= g.weights.value[k] * g.force[a];
      rows[rod_.position_of(i) + a] -= g.weights.value[k] * g.normal[a] * g.mu / rod_.mass_of(i);
    }
  }
  if (body_.moves_freely()) {
    rows.segment<3>(body_.velocity()) += g.force;
    rows.segment<3>(body_.spin()) += g.r_wb.transpose() * g.arm.cross(g.force);
  }
  if (has_bristle()) {
    rows.segment<2>(bristle_unknown()) +=
        at.rate.segment<2>(bristle_unknown()) - bristle_rate(contact_.friction, mode_, g.state);
  }
  rows[first_] += fixed_ ? at.y[first_] - kept_coordinate_ : g.normal.dot(g.slope);
  if (has_law()) {
    rows[force_unknown()] += g.state.normal - contact_.law(-g.gap, -g.gap_rate)[0];
    rows[stabiliser_unknown()] += g.mu;
  } else {
    rows[force_unknown()] += g.gap;
    rows[stabiliser_unknown()] += g.gap_rate;
  }
}

void ContactPart::jacobian(const DaePoint& at, double rate_factor, std::vector<double>& values) {
  const auto add = [&](int row, int column, double value) {
    const int slot = pattern_->slot(row, column);
    if (slot >= 0) values[static_cast<std::size_t>(slot)] += value;
  };
  if (!closed_) {
    for (int k = 0; k < own_unknowns(); ++k) add(first_ + k, first_ + k, 1.0);
    return;
  }
  const Geometry g = geometry(at.y);
  const Vector3d law = has_law() ? contact_.law(-g.gap, -g.gap_rate) : Vector3d::Zero();
  const auto column = [&](int unknown, const Direction& d) {
    const Change c = change(g, d);
    for (int k = 0; k < 4; ++k) {
      const Vector3d row = -g.weights.value[k] * c.force - g.weights.slope[k] * d.zeta * g.force;
      for (int a = 0; a < 3; ++a) {
        const int i = g.weights.first + k;
        if (!rod_.is_held(i, a)) add(rod_.velocity_of(i) + a, unknown, row[a]);
      }
    }
    if (body_.moves_freely()) {
      for (int a = 0; a < 3; ++a) {
        add(body_.velocity() + a, unknown, c.force[a]);
        add(body_.spin() + a, unknown, -c.torque[a]);
      }
    }
    for (int a = 0; has_bristle() && a < 2; ++a) {
      const double rate = mode_ == FrictionMode::stick
                              ? c.sliding[a]
                              : (c.friction[a] / contact_.friction.bristle_stiffness() - d.bristle[a]) /
                                    contact_.friction.bristle_time;
      add(bristle_unknown() + a, unknown, -rate);
    }
    if (!fixed_) add(first_, unknown, c.tangency);
    if (has_law()) {
      add(force_unknown(), unknown, d.lambda + law[1] * c.gap + law[2] * c.gap_rate);
    } else {
      add(force_unknown(), unknown, c.gap);
      add(stabiliser_unknown(), unknown, c.gap_rate);
    }
  };
  for (int k = 0; k < 4; ++k) {
    const int i = g.weights.first + k;
    for (int a = 0; a < 3; ++a) {
      Direction d;
      d.x = g.weights.value[k] * Vector3d::Unit(a);
      d.slope = g.weights.slope[k] * Vector3d::Unit(a);
      // The velocity's share in N' zeta is in g.slope_v already.
      column(rod_.position_of(i) + a, d);
      Direction e;
      e.v = g.weights.value[k] * Vector3d::Unit(a);
      column(rod_.velocity_of(i) + a, e);
      if (!rod_.is_held(i, a)) {
        add(rod_.position_of(i) + a, stabiliser_unknown(),
            -g.weights.value[k] * g.normal[a] / rod_.mass_of(i));
      }
    }
  }
  const Eigen::Matrix<double, 3, 4> turn =
      4.0 * g.r_wb * multibody::quaternion_rates(at.y.segment<4>(body_.quaternion())).transpose();
  for (int a = 0; a < 4; ++a) {
    Direction d;
    d.turn = turn.col(a);
    column(body_.quaternion() + a, d);
  }
  for (int a = 0; a < 3; ++a) {
    Direction d;
    d.p = Vector3d::Unit(a);
    column(body_.position() + a, d);
    Direction e;
    e.body_velocity = Vector3d::Unit(a);
    column(body_.velocity() + a, e);
    Direction f;
    f.spin = Vector3d::Unit(a);
    column(body_.spin() + a, f);
  }
  Direction d;
  d.zeta = 1.0;
  column(first_, d);
  Direction e;
  e.lambda = 1.0;
  column(force_unknown(), e);
  for (int a = 0; has_bristle() && a < 2; ++a) {
    Direction z;
    z.bristle = Vector2d::Unit(a);
    column(bristle_unknown() + a, z);
    add(bristle_unknown() + a, bristle_unknown() + a, rate_factor);
  }
  if (has_law()) add(stabiliser_unknown(), stabiliser_unknown(), 1.0);
  if (fixed_) add(first_, first_, 1.0);
}

void ContactPart::events(const DaePoint& at, std::span<double> values) {
  if (!closed_)
    values[0] = 1.0;
  else
    values[0] = has_law() ? -geometry(at.y).gap : at.y[force_unknown()] - least_force_;
}

// A minimum that flattens out is followed no further: beyond it zeta would be a maximum, or jump. The wire still rests there, and
// where it then dips beside it is found as another touch.                                          theory.md (G.9)
bool ContactPart::accept(const DaePoint& at) {
  if (!closed_) return false;
  if (at.y[force_unknown()] > 0.0) least_force_ = 0.0;
  const Geometry g = geometry(at.y);
  const double slope = g.normal.dot(g.slope);
  if (!fixed_) {
    fixed_ = is_at_an_end(at.y[first_]) || gap_curvature(g) < least_curvature;
    kept_coordinate_ = std::clamp(at.y[first_], 0.0, rod_.coordinate(rod_.vertices() - 1));
  } else if (slope * fixed_slope_ < 0.0 && gap_curvature(g) > 2.0 * least_curvature) {
    fixed_ = false;
  }
  // Along a flat face the slope is round-off of either sign, which says nothing.
  fixed_slope_ = std::abs(slope) > level_slope ? slope : 0.0;
  return follow(at.y);
}

void ContactPart::begin_force(double force, Eigen::VectorXd& y) {
  y[force_unknown()] = force;
  least_force_ = force > 0.0 ? 0.0 : force - options_.force_tolerance;
}

void ContactPart::rest_on_wire() {
  fixed_ = true;
  fixed_slope_ = 0.0;
}

double ContactPart::gap_curvature(const Geometry& g) const {
  Direction along;
  along.zeta = 1.0;
  return change(g, along).tangency;
}

bool ContactPart::is_at_an_end(double coordinate) const {
  return coordinate <= 0.0 || coordinate >= rod_.coordinate(rod_.vertices() - 1);
}

bool ContactPart::follow(const VectorView& y) {
  const int first = curve_weights(rod_, y[first_]).first;
  if (first >= window_ && first + 4 <= window_ + window_size) return false;
  window_ = std::clamp(first - (window_size - 4) / 2, 0, std::max(0, rod_.vertices() - window_size));
  return true;
}

std::optional<double> ContactPart::level_vertex(double coordinate, Eigen::VectorXd y) const {
  y[first_] = coordinate;
  const Geometry here = geometry(y);
  if (is_at_an_end(coordinate) || gap_curvature(here) >= least_curvature) return std::nullopt;
  double nearest = rod_.coordinate(1);
  for (int i = 2; i + 1 < rod_.vertices(); ++i) {
    if (std::abs(rod_.coordinate(i) - coordinate) < std::abs(nearest - coordinate)) nearest = rod_.coordinate(i);
  }
  y[first_] = nearest;
  return std::abs(geometry(y).gap - here.gap) < level_gap ? std::optional(nearest) : std::nullopt;
}

bool ContactPart::close(double coordinate, Eigen::VectorXd& y) {
  closed_ = true;
  mode_ = FrictionMode::stick;
  y[first_] = kept_coordinate_ = coordinate;
  y[stabiliser_unknown()] = 0.0;
  // The wire is moved out by what a touch is noticed late, so that the constraint holds from the start.
  for (int iteration = 0; iteration < 2 && !has_law(); ++iteration) {
    const Geometry g = geometry(y);
    double square = 0.0;
    for (int k = 0; k < 4; ++k) {
      for (int a = 0; a < 3; ++a) {
        if (!rod_.is_held(g.weights.first + k, a)) square += std::pow(g.weights.value[k] * g.normal[a], 2);
      }
    }
    for (int k = 0; k < 4 && square > 0.0; ++k) {
      const int i = g.weights.first + k;
      for (int a = 0; a < 3; ++a) {
        if (!rod_.is_held(i, a))
          y[rod_.position_of(i) + a] -= g.weights.value[k] * g.normal[a] * g.gap / square;
      }
    }
  }
  const Geometry g = geometry(y);
  fixed_ = is_at_an_end(coordinate) || gap_curvature(g) < least_curvature;
  fixed_slope_ = 0.0;
  const bool added = !coupled_;
  coupled_ = true;
  return follow(y) || added;
}

double ContactPart::open(Eigen::VectorXd& y) {
  const double held = closed_ ? bristle_energy(y) : 0.0;
  closed_ = false;
  kept_coordinate_ = y[first_];
  y[force_unknown()] = 0.0;
  y[stabiliser_unknown()] = 0.0;
  if (has_bristle()) y.segment<2>(bristle_unknown()).setZero();
  return held;
}

ContactSample ContactPart::sample(const DaePoint& at) const {
  ContactSample s;
  const Geometry g = geometry(at.y);
  s.closed = closed_;
  s.gap = g.gap;
  s.force = g.force;
  s.normal_force = g.state.normal;
  s.point = g.x;
  s.arc = at.y[first_];
  s.slip_speed = g.state.sliding.norm();
  s.sticking = has_bristle() && mode_ == FrictionMode::stick;
  return s;
}

double ContactPart::gap(const VectorView& y) const {
  return geometry(y).gap;
}

double ContactPart::gap_rate(const VectorView& y) const {
  return geometry(y).gap_rate;
}

double ContactPart::lost_power(const VectorView& y) const {
  if (!closed_) return 0.0;
  const Geometry g = geometry(y);
  // What the pair of forces takes from wire and body together; a law's spring part returns it.
  const double heat = friction_heat(contact_.friction, mode_, g.state);
  return has_law() ? heat - g.state.normal * g.gap_rate : heat;
}

double ContactPart::friction_margin(const VectorView& y) const {
  if (!closed_ || !has_bristle()) return 1.0;
  return coupling::friction_margin(contact_.friction, mode_, geometry(y).state);
}

double ContactPart::sliding_speed(const VectorView& y) const {
  return geometry(y).state.sliding.norm();
}

double ContactPart::bristle_energy(const VectorView& y) const {
  if (!has_bristle()) return 0.0;
  return 0.5 * contact_.friction.bristle_stiffness() * y.segment<2>(bristle_unknown()).squaredNorm();
}

void ContactPart::set_bristle_rate(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const {
  if (!has_bristle()) return;
  rate.segment<2>(bristle_unknown()).setZero();
  if (closed_) rate.segment<2>(bristle_unknown()) = bristle_rate(contact_.friction, mode_, geometry(y).state);
}

void ContactPart::respond_along(const Geometry& g, const Vector3d& impulse, Eigen::VectorXd& dv) const {
  for (int k = 0; k < 4; ++k) {
    const int i = g.weights.first + k;
    for (int a = 0; a < 3; ++a) {
      if (!rod_.is_held(i, a)) dv[rod_.velocity_of(i) + a] += g.weights.value[k] * impulse[a] / rod_.mass_of(i);
    }
  }
  if (!body_.moves_freely()) return;
  dv.segment<3>(body_.velocity()) -= impulse / body_.body().properties.mass;
  dv.segment<3>(body_.spin()) -= body_.inverse_inertia() * (g.r_wb.transpose() * g.arm.cross(impulse));
}

void ContactPart::apply_impulse(const VectorView& y, double impulse, Eigen::VectorXd& dv) const {
  const Geometry g = geometry(y);
  respond_along(g, impulse * g.normal, dv);
}

void ContactPart::respond_with_friction(const VectorView& y, double force, Eigen::VectorXd& rate) const {
  const Geometry g = geometry(y);
  respond_along(g, force * (g.normal - g.in_world(g.friction.by_normal)), rate);
}

std::array<Vector3d, 2> ContactPart::force_on_mounts(const VectorView& y) const {
  if (!closed_) return {Vector3d::Zero(), Vector3d::Zero()};
  return share_of_mounts(y, geometry(y).force);
}

std::array<Vector3d, 2> ContactPart::share_of_mounts(const VectorView& y, const Vector3d& force) const {
  std::array<Vector3d, 2> result{Vector3d::Zero(), Vector3d::Zero()};
  const CurveWeights w = curve_weights(rod_, std::clamp(y[first_], 0.0, rod_.coordinate(rod_.vertices() - 1)));
  for (int k = 0; k < 4; ++k) {
    const int i = w.first + k;
    if (i != 0 && i != rod_.vertices() - 1) continue;
    for (int a = 0; a < 3; ++a) {
      if (rod_.is_held(i, a)) result[i == 0 ? 0 : 1][a] += w.value[k] * force[a];
    }
  }
  return result;
}

Vector3d ContactPart::normal(const VectorView& y) const {
  return geometry(y).normal;
}

void ContactPart::save_state(std::vector<double>& memory) const {
  memory.insert(memory.end(), {closed_ ? 1.0 : 0.0, kept_coordinate_, static_cast<double>(window_), coupled_ ? 1.0 : 0.0,
                                fixed_ ? 1.0 : 0.0, fixed_slope_, least_force_, mode_ == FrictionMode::stick ? 1.0 : 0.0});
}

void ContactPart::restore_state(const VectorView& /*y*/, std::span<const double>& memory) {
  closed_ = numerics::take(memory) != 0.0;
  kept_coordinate_ = numerics::take(memory);
  window_ = static_cast<int>(numerics::take(memory));
  coupled_ = numerics::take(memory) != 0.0;
  fixed_ = numerics::take(memory) != 0.0;
  fixed_slope_ = numerics::take(memory);
  least_force_ = numerics::take(memory);
  mode_ = numerics::take(memory) != 0.0 ? FrictionMode::stick : FrictionMode::slip;
}

double ContactPart::gap_rate_of(const VectorView& y, const Eigen::VectorXd& velocities) const {
  const Geometry g = geometry(y);
  Vector3d v = Vector3d::Zero();
  for (int k = 0; k < 4; ++k)
    v += g.weights.value[k] * velocities.segment<3>(rod_.velocity_of(g.weights.first + k));
  return g.normal.dot(v - velocities.segment<3>(body_.velocity()) -
                      (g.r_wb * velocities.segment<3>(body_.spin())).cross(g.arm));
}

double ContactPart::gap_acceleration_at_rest(const VectorView& y) const {
  const Geometry g = geometry(y);
  Direction d;
  d.x = g.v;
  d.slope = g.slope_v;
  d.p = g.body_velocity;
  d.turn = g.omega;
  // zeta keeps the tangency.
  if (!fixed_) d.zeta = -change(g, d).tangency / gap_curvature(g);
  return change(g, d).gap_rate;
}

}  // namespace snare::coupling
