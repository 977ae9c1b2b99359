#include "coupling/contact/friction.hpp"

#include <cmath>

namespace snare::coupling {

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

/// Coefficient over the sliding speed and its derivative by the speed, over the speed: both finite at rest.
struct SmoothLaw {
  double over_speed = 0.0;  ///< mu(s)/s [s/m]
  double slope = 0.0;       ///< d(mu/s)/ds / s [s^3/m^3]
};

/// Coefficient in the slip and its derivative over the speed, (dmu/ds)/s [s^2/m^2].
struct SlipLaw {
  double coefficient = 0.0;
  double slope = 0.0;
};

SlipLaw slip_law(const MotionFriction& f, double s) {
  constexpr double at_once = 1e-5;  // "both speeds 0" [m/s]
  const double end = f.dynamic_speed > 0.0 ? f.dynamic_speed : at_once;
  if (s >= end) return {f.dynamic_coefficient, 0.0};
  if (s <= f.static_speed) return {f.static_coefficient, 0.0};
  const double width = end - f.static_speed;
  const double x = (s - f.static_speed) / width;
  const double fall = f.dynamic_coefficient - f.static_coefficient;
  return {f.static_coefficient + fall * x * x * (3.0 - 2.0 * x), fall * 6.0 * x * (1.0 - x) / (width * s)};
}

// Cubic steps: from -static at -static_speed to +static at +static_speed, then on to the dynamic coefficient.
SmoothLaw smooth_law(const MotionFriction& f, double s) {
  if (s < f.static_speed) {
    const double x = s / f.static_speed;
    // mu/s = static/static_speed (3 - x^2)/2
    const double scale = f.static_coefficient / f.static_speed;
    return {0.5 * scale * (3.0 - x * x), -scale / (f.static_speed * f.static_speed)};
  }
  const SlipLaw slip = slip_law(f, s);
  return {slip.coefficient / s, slip.slope / s - slip.coefficient / (s * s * s)};
}

/// How much of the speed along the bristle its slider takes, and the derivative by the share |z|/z_m.
struct SliderShare {
  double value = 0.0, slope = 0.0;
};

SliderShare slider_share(double share) {
  constexpr double sticks_up_to = 0.999;
  constexpr double width = 1.0 - sticks_up_to;
  if (share <= sticks_up_to) return {};
  const double x = (share - sticks_up_to) / width;
  // Beyond 1 straight on: what has been stretched too far comes back.
  return x < 1.0 ? SliderShare{x * x, 2.0 * x / width} : SliderShare{2.0 * x - 1.0, 2.0 / width};
}

}  // namespace

double slip_coefficient(const MotionFriction& friction, double speed) {
  return slip_law(friction, speed).coefficient;
}

BristleRate bristle_rate(const MotionFriction& friction, const BristleState& at) {
  BristleRate r;
  r.rate = at.sliding;
  const double size = at.bristle.norm();
  const SliderShare share = slider_share(size / friction.bristle_displacement);
  if (share.value == 0.0) return r;
  const Vector2d direction = at.bristle / size;
  const double along = at.sliding.dot(direction);
  if (along <= 0.0) return r;
  r.rate -= share.value * along * direction;
  const Matrix2d axis = direction * direction.transpose();
  const Matrix2d across = (Matrix2d::Identity() - axis) / size;
  r.by_sliding -= share.value * axis;
  r.by_bristle = -(share.slope / friction.bristle_displacement * along * axis +
                   share.value * (direction * at.sliding.transpose() * across + along * across));
  return r;
}

TangentForce tangent_force(const MotionFriction& friction, const BristleState& at) {
  TangentForce t;
  if (!friction.acts()) return t;
  const double speed = at.sliding.norm();
  if (friction.law == ContactFriction::smooth) {
    const SmoothLaw law = smooth_law(friction, speed);
    t.by_normal = law.over_speed * at.sliding;
    t.force = at.normal * t.by_normal;
    t.by_sliding =
        at.normal * (law.over_speed * Matrix2d::Identity() + law.slope * at.sliding * at.sliding.transpose());
    return t;
  }
  const SlipLaw law = slip_law(friction, speed);
  const BristleRate rate = bristle_rate(friction, at);
  const Vector2d reach = (at.bristle + friction.bristle_time * rate.rate) / friction.bristle_displacement;
  t.by_normal = law.coefficient * reach;
  t.force = at.normal * t.by_normal;
  const double stiffness = at.normal * law.coefficient / friction.bristle_displacement;
  t.by_bristle = stiffness * (Matrix2d::Identity() + friction.bristle_time * rate.by_bristle);
  t.by_sliding =
      stiffness * friction.bristle_time * rate.by_sliding + at.normal * law.slope * reach * at.sliding.transpose();
  return t;
}

}  // namespace snare::coupling
