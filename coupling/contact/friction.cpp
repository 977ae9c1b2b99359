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

/// What a slider lets a spring and its dashpot carry together: e = z + tau w, brought back into the circle of radius z_m.
struct Carried {
  Vector2d reach;     ///< m [m]
  Matrix2d by_total;  ///< dm/de [-]
  bool slides;
};

Carried carried(const MotionFriction& friction, const BristleState& at) {
  const Vector2d total = at.bristle + friction.bristle_time * at.sliding;
  const double size = total.norm(), most = friction.bristle_displacement;
  if (size <= most) return {total, Matrix2d::Identity(), false};
  const Vector2d direction = total / size;
  return {most * direction, most / size * (Matrix2d::Identity() - direction * direction.transpose()), true};
}

}  // namespace

double slip_coefficient(const MotionFriction& friction, double speed) {
  return slip_law(friction, speed).coefficient;
}

BristleRate bristle_rate(const MotionFriction& friction, const BristleState& at) {
  const Carried m = carried(friction, at);
  if (!m.slides) return {at.sliding, Matrix2d::Identity(), Matrix2d::Zero()};
  return {(m.reach - at.bristle) / friction.bristle_time, m.by_total,
          (m.by_total - Matrix2d::Identity()) / friction.bristle_time};
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
  const Carried m = carried(friction, at);
  t.by_normal = law.coefficient / friction.bristle_displacement * m.reach;
  t.force = at.normal * t.by_normal;
  t.by_bristle = at.normal * law.coefficient / friction.bristle_displacement * m.by_total;
  t.by_sliding = friction.bristle_time * t.by_bristle +
                 at.normal * law.slope / friction.bristle_displacement * m.reach * at.sliding.transpose();
  return t;
}

}  // namespace snare::coupling
