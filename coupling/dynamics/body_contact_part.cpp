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

/// The points that are in the shape, with its field there.
std::vector<std::pair<std::size_t, DistanceField>> points_inside(const BodyContact& c,
                                                                 const std::array<FrameMotion<double>, 2>& frames) {
  std::vector<std::pair<std::size_t, DistanceField>> inside;
  for (std::size_t k = 0; k < c.points.size(); ++k) {
    const Vector3d p = frames[of_shape].R.transpose() * (frames[of_points].point(c.points[k]) - frames[of_shape].p);
    if (c.shape->distance(p) < c.radius) inside.emplace_back(k, c.shape->at(p));
  }
  return inside;
}

}  // namespace

BodyContactPart::BodyContactPart(const BodyContact& contact, MovingFrame shape, MovingFrame points)
    : PressPart({std::move(shape), std::move(points)}), contact_(contact) {}

std::vector<Wrench> BodyContactPart::wrenches(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  const auto inside = points_inside(contact_, now);
  return inside.empty() ? std::vector<Wrench>{} : plain(wrenches_of(contact_, inside, now));
}

Eigen::MatrixXd BodyContactPart::derivatives(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  return derivatives_of(wrenches_of(contact_, points_inside(contact_, now), with_derivatives(now)));
}

// The law's spring is not told from its dashpot: all that is taken counts as lost, and what it gives back as gained.
FrameForces::Power BodyContactPart::power(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  return {0.0, -power_of(wrenches_of(contact_, points_inside(contact_, now), now), now)};
}

double BodyContactPart::depth(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  double deepest = -std::numeric_limits<double>::max();
  for (const Vector3d& p : contact_.points) {
    const Vector3d local = now[of_shape].R.transpose() * (now[of_points].point(p) - now[of_shape].p);
    deepest = std::max(deepest, contact_.radius - contact_.shape->distance(local));
  }
  return deepest;
}

ContactSample BodyContactPart::sample(const VectorView& y) const {
  const auto now = motions<2>(frames(), y);
  ContactSample sum;
  sum.gap = -depth(y);
  double largest = 0.0;
  for (const auto& [index, field] : points_inside(contact_, now)) {
    const Pressed<double> a = press(contact_, index, field, now);
    if (!(a.normal > 0.0)) continue;
    sum.closed = true;
    sum.normal_force += a.normal;
    sum.force -= a.n * a.normal + smooth_friction(contact_.friction, a.slide, a.normal);
    if (a.normal <= largest) continue;
    largest = a.normal;
    sum.point = a.point;
    sum.slip_speed = a.slide.norm();
  }
  return sum;
}

}  // namespace snare::coupling
