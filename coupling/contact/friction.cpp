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
  if (s >= f.dynamic_speed) return {f.dynamic_coefficient, 0.0};
  if (s <= f.static_speed) return {f.static_coefficient, 0.0};
  const double width = f.dynamic_speed - f.static_speed;
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

Vector2d reach(const MotionFriction& f, const BristleState& at) {
  return at.bristle + f.bristle_time * at.sliding;
}

}  // namespace

double slip_coefficient(const MotionFriction& friction, double speed) {
  return slip_law(friction, speed).coefficient;
}

TangentForce tangent_force(const MotionFriction& friction, FrictionMode mode, const BristleState& at) {
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
  const Vector2d e = reach(friction, at);
  if (mode == FrictionMode::stick) {
    const double k = friction.bristle_stiffness();
    t.force = k * e;
    t.by_bristle = k * Matrix2d::Identity();
    t.by_sliding = friction.bristle_time * t.by_bristle;
    return t;
  }
  const double size = e.norm();
  if (size == 0.0) return t;  // only without a normal force
  const Vector2d direction = e / size;
  const SlipLaw law = slip_law(friction, speed);
  t.by_normal = law.coefficient * direction;
  t.force = at.normal * t.by_normal;
  t.by_bristle = law.coefficient * at.normal / size * (Matrix2d::Identity() - direction * direction.transpose());
  t.by_sliding = friction.bristle_time * t.by_bristle + at.normal * law.slope * direction * at.sliding.transpose();
  return t;
}

Vector2d bristle_rate(const MotionFriction& friction, FrictionMode mode, const BristleState& at) {
  if (mode == FrictionMode::stick) return at.sliding;
  const Vector2d force = tangent_force(friction, mode, at).force;
  return (force / friction.bristle_stiffness() - at.bristle) / friction.bristle_time;
}

double friction_margin(const MotionFriction& friction, FrictionMode mode, const BristleState& at) {
  const double size = friction.bristle_stiffness() * reach(friction, at).norm();
  if (mode == FrictionMode::stick) return (1.0 + slip_onset_margin) * friction.static_coefficient * at.normal - size;
  return size - slip_coefficient(friction, at.sliding.norm()) * at.normal;
}

double friction_heat(const MotionFriction& friction, FrictionMode mode, const BristleState& at) {
  const Vector2d force = tangent_force(friction, mode, at).force;
  if (friction.law == ContactFriction::smooth) return force.dot(at.sliding);
  const Vector2d rate = bristle_rate(friction, mode, at);
  const double dashpot = friction.bristle_stiffness() * friction.bristle_time * rate.squaredNorm();
  return dashpot + force.dot(at.sliding - rate);
}

}  // namespace snare::coupling
