#include "coupling/dynamics/contact/body_contact_part.hpp"

#include "coupling/dynamics/contact/bristle_means.hpp"
#include "coupling/dynamics/contact/contact_integral.hpp"
#include "coupling/dynamics/contact/dual_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace snare::coupling {

using Eigen::Vector3d;
using multibody::Wrench;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

enum Frame : std::size_t { of_shape, of_points };

double lift(double value, const Vector3d& /*slope*/, const Vector3<double>& /*p*/) {
  return value;
}
template <int N>
Dual<N> lift(double value, const Vector3d& slope, const Vector3<Dual<N>>& p) {
  Dual<N> f(value);
  for (int i = 0; i < 3; ++i) f.v += slope[i] * p[i].v;
  return f;
}

/// What one point presses.
template <class S>
struct Pressed {
  S normal{}, elastic{}, elastic_rate{};  // [N], the spring's part of it [N], and the rate of that [N/s]
  double energy = 0.0, damping = 0.0;     // of the spring [J], and power of the damping [W]
  Vector3<S> point;                       // in the world
  Vector3<S> n;                           // of the shape, outward
  Vector3<S> slide = Vector3<S>::Zero();  // of the point on the shape
};

// d = radius - phi(p), p the point in the shape's frame; d' = -n.v of the point against the shape.
template <class S>
Pressed<S> press(const BodyContact& c, std::size_t index, const DistanceField& field,
                 const std::array<FrameMotion<S>, 2>& frames) {
  Pressed<S> a;
  const Vector3<S> centre = frames[of_points].point(c.points[index]);
  const Vector3<S> local = frames[of_shape].R.transpose() * (centre - frames[of_shape].p);
  const S phi = lift(field.distance, field.normal, local);
  Vector3<S> normal;
  for (int i = 0; i < 3; ++i) normal[i] = lift(field.normal[i], field.hessian.row(i), local);
  a.n = frames[of_shape].R * normal;
  a.point = centre - a.n * S(c.radius);
  const Vector3<S> v = frames[of_points].velocity_at(a.point) - frames[of_shape].velocity_at(a.point);
  const S rate = -a.n.dot(v), depth = S(c.radius) - phi;
  const Vector3d law = c.law(value_of(depth), value_of(rate)), spring = c.law.elastic(value_of(depth));
  a.normal = lifted(law.x(), law.y(), depth, law.z(), rate);
  a.elastic = lifted(spring.x(), spring.y(), depth, 0.0, rate);
  a.elastic_rate = lifted(spring.y() * value_of(rate), spring.z() * value_of(rate), depth, spring.y(), rate);
  a.energy = c.law.energy(value_of(depth));
  a.damping = (law.x() - spring.x()) * value_of(rate);
  a.slide = v + a.n * rate;
  return a;
}

/// Friction of one point.
template <class S>
struct Rubbed {
  Vector3<S> force = Vector3<S>::Zero();  // on the shape
  Vector3<S> rate = Vector3<S>::Zero();   // of the bristle, axes of the shape
  double energy = 0.0, heat = 0.0;        // [J], [W]
  double slider_speed = 0.0;              // [m/s]
};

// The law of (M.9) for the part of the bristle in the tangent plane. What stands upright decays as the slider
// does, and all of it forgets: see BristleMeans. z in the axes of the shape.
template <class S>
Rubbed<S> rub(const MotionFriction& friction, const Pressed<S>& a, const Vector3<S>& z,
              const Eigen::Matrix<S, 3, 3>& R_WS) {
  Rubbed<S> r;
  if (!friction.acts()) return r;
  const Vector3<S> bent = R_WS * z, upright = a.n * a.n.dot(bent);
  const BristleInputs<S> in{bent - upright, a.slide, a.normal, a.elastic, a.elastic_rate};
  const BristleStateIn<3> at = in.state();
  const TangentForceIn<3> f = tangent_force(friction, at);
  r.force = lifted(f.force, in, [&](const BristleChangeIn<3>& by) { return force_change(f, by); });
  r.heat = f.force.dot(at.sliding);
  if (!friction.has_bristle()) return r;
  const double time = friction.bristle_time;
  const BristleFlowIn<3> flow = bristle_flow(friction, at, f, value_of(a.elastic_rate));
  const Vector3<S> lying_flow = lifted(
      flow.flow, in, [&](const BristleChangeIn<3>& by) { return flow_change(friction, at, f, flow, by); });
  const S decay =
      a.elastic / S(time) + S(0.5) * (flow.growth_follows ? a.elastic_rate : -a.elastic / S(time));
  const S load = a.elastic + S(idle_load), forgetting = forgetting_rate(load, time);
  r.rate = R_WS.transpose() * ((lying_flow - upright * decay) / load - bent * forgetting);
  r.slider_speed = f.slider_speed;
  const double stiffness = friction.static_coefficient / friction.bristle_displacement;
  const double square = values_of(bent).squaredNorm(), upright_square = values_of(upright).squaredNorm();
  r.energy = 0.5 * stiffness * value_of(load) * square;
  r.heat = flow.heat + stiffness * (value_of(forgetting * load) * square +
                                    (value_of(decay) - 0.5 * value_of(a.elastic_rate)) * upright_square);
  return r;
}

template <class S>
void add_wrenches(std::array<FrameWrench<S>, 2>& wrenches, const std::array<FrameMotion<S>, 2>& frames,
                  const Pressed<S>& a, const Rubbed<S>& r) {
  const Vector3<S> force = a.n * a.normal - r.force;
  wrenches[of_points].add(frames[of_points], a.point, force);
  wrenches[of_shape].add(frames[of_shape], a.point, -force);
}

}  // namespace

struct BodyContactPart::Acting {
  std::size_t point = 0;
  Pressed<double> pressed;
  Rubbed<double> rubbed;
};

BodyContactPart::BodyContactPart(const BodyContact& contact, MovingFrame shape, MovingFrame points)
    : UnilateralForcePart({std::move(shape), std::move(points)}),
      contact_(contact),
      tree_(contact.points),
      coupled_(contact.points.size(), false) {}

void BodyContactPart::declare(numerics::DaeLayout& layout) {
  if (!has_bristle()) return;
  // Outside of the error test: z is the integral of a sliding whose displacements are tested.
  bristle_ = layout.add({contact_.name + " bristle",
                         {"x", "y", "z"},
                         3 * static_cast<int>(contact_.points.size()),
                         numerics::DaeKind::algebraic,
                         0.1 * contact_.friction.bristle_displacement,
                         0});
}

void BodyContactPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  FrameForces::sparsity(entries);
  for (std::size_t k = 0; has_bristle() && k < coupled_.size(); ++k) {
    for (int a = bristle_of(k); a < bristle_of(k) + 3; ++a) {
      entries.emplace_back(a, a);
      if (!coupled_[k]) continue;
      for (int b = bristle_of(k); b < bristle_of(k) + 3; ++b) entries.emplace_back(a, b);
      for (const MovingFrame& frame : frames()) {
        for (const int column : frame.coordinates()) entries.emplace_back(a, column);
        for (const int column : frame.velocities()) {
          entries.emplace_back(a, column);
          if (frame.moves_freely()) entries.emplace_back(column, a);
        }
      }
    }
  }
}

bool BodyContactPart::outgrows_pattern(const numerics::DaePoint& at) {
  if (!has_bristle()) return false;
  bool more = false;
  for (const auto& [index, field] : points_inside(motions<2>(frames(), at.y))) {
    more = more || !coupled_[index];
    coupled_[index] = true;
  }
  return more;
}

void BodyContactPart::save_state(std::vector<double>& memory) const {
  memory.insert(memory.end(), {seen_.closed ? 1.0 : 0.0, seen_.sticking ? 1.0 : 0.0});
}

void BodyContactPart::restore_state(const VectorView& /*y*/, std::span<const double>& memory) {
  coupled_.assign(coupled_.size(), false);
  seen_.closed = numerics::take(memory) != 0.0;
  seen_.sticking = numerics::take(memory) != 0.0;
}

std::optional<base::InputProblem> BodyContactPart::overlap(const VectorView& y, double /*tolerance*/) const {
  constexpr double of_radius = 0.1;
  const double deepest = of_radius * contact_.radius;
  const double depth_now = contact_.radius > 0.0 ? depth(y) : 0.0;
  if (depth_now <= deepest) return {};
  return base::InputProblem{
      "", 0, contact_.name + ".gap", fmt::format("{:.6g} m", -depth_now),
      fmt::format("must be >= {:.6g} m at the start, a tenth of the radius of what touches", -deepest)};
}

std::vector<MotionEvent> BodyContactPart::changes(const DaePoint& now, double time_before, bool event) {
  const auto [sample, work, tension] = pressing(now.y);
  const bool closed = !work.wrenches.empty();
  const Seen before = std::exchange(seen_, {closed, sample.sticking});
  std::vector<MotionEvent> events;
  if (closed && !before.closed && !event)
    events.push_back({.time = time_before, .kind = MotionEvent::Kind::touch});
  if (!has_bristle() || !closed || !before.closed || sample.sticking == before.sticking) return events;
  const auto kind = sample.sticking ? MotionEvent::Kind::stick : MotionEvent::Kind::slip;
  events.push_back({.time = now.time, .kind = kind, .approach_speed = sample.slip_speed});
  return events;
}

Vector3d BodyContactPart::bristle(const VectorView& y, std::size_t point) const {
  return has_bristle() ? Vector3d(y.segment<3>(bristle_of(point))) : Vector3d::Zero();
}

std::vector<BodyContactPart::Acting> BodyContactPart::acting(const Frames& now, const VectorView& y) const {
  std::vector<Acting> list;
  for (const auto& [index, field] : points_inside(now)) {
    const Pressed<double> a = press(contact_, index, field, now);
    list.push_back({index, a, rub(contact_.friction, a, bristle(y, index), now[of_shape].R)});
  }
  return list;
}

void BodyContactPart::residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  const auto now = motions<2>(frames(), at.y);
  const std::vector<Acting> list = acting(now, at.y);
  if (!list.empty()) {
    std::array<FrameWrench<double>, 2> wrenches;
    for (const Acting& a : list) add_wrenches(wrenches, now, a.pressed, a.rubbed);
    for (std::size_t k = 0; k < 2; ++k)
      frames()[k].push(at.y, Wrench{wrenches[k].moment, wrenches[k].force}, rows);
  }
  if (!has_bristle()) return;
  const Eigen::VectorXd rates = bristle_rates(list, at.y);
  rows.segment(bristle_, rates.size()) += at.rate.segment(bristle_, rates.size()) - rates;
}

Eigen::VectorXd BodyContactPart::bristle_rates(const std::vector<Acting>& list, const VectorView& y) const {
  const double idle = forgetting_rate(idle_load, contact_.friction.bristle_time);
  Eigen::VectorXd rates = -idle * y.segment(bristle_, 3 * static_cast<Eigen::Index>(contact_.points.size()));
  for (const Acting& a : list) rates.segment<3>(3 * static_cast<Eigen::Index>(a.point)) = a.rubbed.rate;
  return rates;
}

void BodyContactPart::set_bristle_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const {
  if (!has_bristle()) return;
  const Eigen::VectorXd rates = bristle_rates(acting(motions<2>(frames(), y), y), y);
  rate.segment(bristle_, rates.size()) = rates;
}

void BodyContactPart::jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) {
  FrameForces::jacobian(at, c, values);
  if (!has_bristle()) return;
  const numerics::PatternValues into(slots(), values);
  std::vector<bool> inside(coupled_.size(), false);
  for (const auto& [index, field] : points_inside(motions<2>(frames(), at.y))) inside[index] = true;
  const double idle = forgetting_rate(idle_load, contact_.friction.bristle_time);
  for (std::size_t k = 0; k < coupled_.size(); ++k) {
    for (int a = bristle_of(k); a < bristle_of(k) + 3; ++a) into.add(a, a, inside[k] ? c : c + idle);
  }
}

Vector3d BodyContactPart::in_shape(const Frames& now, const Vector3d& point) {
  return now[of_shape].R.transpose() * (now[of_points].point(point) - now[of_shape].p);
}

std::vector<Wrench> BodyContactPart::wrenches(const VectorView& y) const {
  return pressing(y).work.wrenches;
}

std::vector<int> BodyContactPart::inner(const VectorView& y) const {
  std::vector<int> unknowns;
  if (!has_bristle()) return unknowns;
  for (const auto& [index, field] : points_inside(motions<2>(frames(), y))) {
    for (int a = 0; a < 3; ++a) unknowns.push_back(bristle_of(index) + a);
  }
  return unknowns;
}

Eigen::MatrixXd BodyContactPart::derivatives(const VectorView& y) const {
  using Variables = FrameVariables<2>;
  constexpr int first_bristle = Variables::count;
  constexpr Eigen::Index frame_rows = 2 * wrench_rows, frame_columns = 2 * motion_columns;
  const auto now = motions<2>(frames(), y);
  const auto dual = with_derivatives<Variables, 3>(now);
  using S = Dual<first_bristle + 3>;
  const Inside inside = points_inside(now);
  const Eigen::Index inner = has_bristle() ? 3 * static_cast<Eigen::Index>(inside.size()) : 0;
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(frame_rows + inner, frame_columns + inner);
  Eigen::Index k = 0;
  for (const auto& [index, field] : inside) {
    Vector3<S> z = bristle(y, index).cast<S>();
    for (int i = 0; has_bristle() && i < 3; ++i) z[i].v[first_bristle + i] = 1.0;
    const Pressed<S> a = press(contact_, index, field, dual);
    const Rubbed<S> r = rub(contact_.friction, a, z, dual[of_shape].R);
    std::array<FrameWrench<S>, 2> wrenches;
    add_wrenches(wrenches, dual, a, r);
    add_derivatives<Variables>(wrenches, D);
    if (!has_bristle()) continue;
    add_derivatives<Variables, 2>(r.rate, frame_rows + k, D);
    Eigen::Index row = 0;
    const auto by_bristle = [&](const Vector3<S>& vector, Eigen::Index at) {
      for (int i = 0; i < 3; ++i)
        D.block<1, 3>(at + i, frame_columns + k) = vector[i].v.template segment<3>(first_bristle).transpose();
    };
    for (const FrameWrench<S>& w : wrenches) {
      by_bristle(w.moment, row);
      by_bristle(w.force, row + 3);
      row += wrench_rows;
    }
    by_bristle(r.rate, frame_rows + k);
    k += 3;
  }
  return D;
}

// A ball round some points that the shape is farther from than from the ball's radius has none of them
// inside.
BodyContactPart::Inside BodyContactPart::points_inside(const Frames& now) const {
  Inside inside;
  tree_.visit([&](const PointTree::Ball& ball) {
    const Vector3d p = in_shape(now, ball.centre);
    if (contact_.shape->distance(p) - ball.radius >= contact_.radius) return false;
    if (ball.point) inside.emplace_back(*ball.point, contact_.shape->at(p));
    return true;
  });
  std::ranges::sort(inside, {}, [](const auto& point) { return point.first; });
  return inside;
}

double BodyContactPart::depth(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  double deepest = -std::numeric_limits<double>::max();
  tree_.visit([&](const PointTree::Ball& ball) {
    const double distance = contact_.shape->distance(in_shape(now, ball.centre));
    if (ball.point) deepest = std::max(deepest, contact_.radius - distance);
    // What is said of distances holds outside.
    return distance < 0.0 || contact_.radius - (distance - ball.radius) > deepest;
  });
  return deepest;
}

// Of balls that are outside as a whole, how deep they are at most.
double BodyContactPart::touches(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  double deepest = -std::numeric_limits<double>::max();
  tree_.visit([&](const PointTree::Ball& ball) {
    const double most = contact_.radius + ball.radius - contact_.shape->distance(in_shape(now, ball.centre));
    if (!ball.point && most > 0.0) return true;
    deepest = std::max(deepest, most);
    return false;
  });
  return deepest;
}

UnilateralForcePart::Pressing BodyContactPart::pressing(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  const std::vector<Acting> list = acting(now, y);
  Pressing p;
  if (list.empty()) return p;
  double largest = 0.0;
  std::array<FrameWrench<double>, 2> wrenches;
  for (const Acting& one : list) {
    const Pressed<double>& a = one.pressed;
    const Rubbed<double>& r = one.rubbed;
    add_wrenches(wrenches, now, a, r);
    p.work.power.energy += a.energy + r.energy;
    p.work.power.lost += a.damping + r.heat;
    if (!(a.normal > 0.0)) continue;
    p.sample.closed = true;
    p.sample.normal_force += a.normal;
    p.sample.sticking = p.sample.sticking || (has_bristle() && r.slider_speed <= standing);
    if (a.normal <= largest) continue;
    largest = a.normal;
    p.sample.point = a.point;
    p.sample.slip_speed = a.slide.norm();
  }
  p.work.wrenches = plain(wrenches);
  p.sample.force = wrenches[of_shape].force;
  return p;
}

}  // namespace snare::coupling
