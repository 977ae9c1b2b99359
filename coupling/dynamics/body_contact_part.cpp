#include "coupling/dynamics/body_contact_part.hpp"

#include "coupling/dynamics/dual_frames.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace snare::coupling {

using Eigen::Vector3d;
using multibody::Wrench;
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
  S normal{};                             // [N]
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
  const Vector3d law = c.law(value_of(depth), value_of(rate));
  a.normal = lifted(law.x(), law.y(), depth, law.z(), rate);
  a.slide = v + a.n * rate;
  return a;
}

template <class S>
std::array<FrameWrench<S>, 2> wrenches_of(const BodyContact& c,
                                          const std::vector<std::pair<std::size_t, DistanceField>>& inside,
                                          const std::array<FrameMotion<S>, 2>& frames) {
  std::array<FrameWrench<S>, 2> wrenches;
  for (const auto& [index, field] : inside) {
    const Pressed<S> a = press(c, index, field, frames);
    if (!(value_of(a.normal) > 0.0)) continue;
    const Vector3<S> force = a.n * a.normal + smooth_friction(c.friction, a.slide, a.normal);
    wrenches[of_points].add(frames[of_points], a.point, force);
    wrenches[of_shape].add(frames[of_shape], a.point, -force);
  }
  return wrenches;
}

}  // namespace

BodyContactPart::BodyContactPart(const BodyContact& contact, MovingFrame shape, MovingFrame points)
    : PressPart({std::move(shape), std::move(points)}), contact_(contact), tree_(contact.points) {}

Vector3d BodyContactPart::in_shape(const Frames& now, const Vector3d& point) {
  return now[of_shape].R.transpose() * (now[of_points].point(point) - now[of_shape].p);
}

std::vector<Wrench> BodyContactPart::wrenches(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  const auto inside = points_inside(now);
  return inside.empty() ? std::vector<Wrench>{} : plain(wrenches_of(contact_, inside, now));
}

Eigen::MatrixXd BodyContactPart::derivatives(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  using Variables = FrameVariables<2>;
  return derivatives_of<Variables>(wrenches_of(contact_, points_inside(now), with_derivatives<Variables>(now)));
}

// A ball round some points that the shape is farther from than from the ball's radius has none of them inside.
std::vector<std::pair<std::size_t, DistanceField>> BodyContactPart::points_inside(const Frames& now) const {
  std::vector<std::pair<std::size_t, DistanceField>> inside;
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

// The law's spring is not told from its dashpot: all that is taken counts as lost, and what it gives back as gained.
PressPart::Pressing BodyContactPart::pressing(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  const auto inside = points_inside(now);
  Pressing p;
  if (inside.empty()) return p;
  double largest = 0.0;
  for (const auto& [index, field] : inside) {
    const Pressed<double> a = press(contact_, index, field, now);
    if (!(a.normal > 0.0)) continue;
    p.sample.closed = true;
    p.sample.normal_force += a.normal;
    p.sample.force -= a.n * a.normal + smooth_friction(contact_.friction, a.slide, a.normal);
    if (a.normal <= largest) continue;
    largest = a.normal;
    p.sample.point = a.point;
    p.sample.slip_speed = a.slide.norm();
  }
  const auto wrenches = wrenches_of(contact_, inside, now);
  p.work = {plain(wrenches), {0.0, -power_of(wrenches, now)}};
  return p;
}

}  // namespace snare::coupling
