#include "coupling/contact/friction.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

using Eigen::Vector;

namespace {

/// Coefficient over the sliding speed and its derivative by the speed, over the speed: both finite at rest.
struct SmoothLaw {
  double over_speed = 0.0;  ///< mu(s)/s [s/m]
  double slope = 0.0;       ///< d(mu/s)/ds / s [s^3/m^3]
};

// Cubic steps: from -static at -static_speed to +static at +static_speed, then on to the dynamic coefficient.
SmoothLaw smooth_law(const MotionFriction& f, double s) {
  if (s < f.static_speed) {
    const double x = s / f.static_speed;
    // mu/s = static/static_speed (3 - x^2)/2
    const double scale = f.static_coefficient / f.static_speed;
    return {0.5 * scale * (3.0 - x * x), -scale / (f.static_speed * f.static_speed)};
  }
  const SlipCoefficient slip = slip_coefficient(f, s);
  return {slip.value / s, slip.slope / (s * s) - slip.value / (s * s * s)};
}

template <int N>
TangentForceIn<N> smooth_force(const MotionFriction& friction, const BristleStateIn<N>& at) {
  TangentForceIn<N> t;
  const SmoothLaw law = smooth_law(friction, at.sliding.norm());
  t.by_normal = law.over_speed * at.sliding;
  t.force = at.normal * t.by_normal;
  t.by_sliding = at.normal * (law.over_speed * Eigen::Matrix<double, N, N>::Identity() +
                              law.slope * at.sliding * at.sliding.transpose());
  return t;
}

}  // namespace

SlipCoefficient slip_coefficient(const MotionFriction& f, double s) {
  constexpr double at_once = 1e-5;  // "both speeds 0" [m/s]
  const double end = f.dynamic_speed > 0.0 ? f.dynamic_speed : at_once;
  if (s >= end) return {f.dynamic_coefficient, 0.0};
  if (s <= f.static_speed) return {f.static_coefficient, 0.0};
  const double width = end - f.static_speed;
  const double x = (s - f.static_speed) / width;
  const double fall = f.dynamic_coefficient - f.static_coefficient;
  return {f.static_coefficient + fall * x * x * (3.0 - 2.0 * x), fall * 6.0 * x * (1.0 - x) / width};
}

template <int N>
TangentForceIn<N> tangent_force(const MotionFriction& friction, const BristleStateIn<N>& at) {
  if (!friction.acts()) return {};
  if (friction.law == ContactFriction::smooth) return smooth_force(friction, at);
  using Square = Eigen::Matrix<double, N, N>;
  TangentForceIn<N> t;
  const Vector<double, N> total = at.bristle + friction.bristle_time * at.sliding;
  const double size = total.norm(), speed = at.sliding.norm();
  const double stiffness = friction.static_coefficient / friction.bristle_displacement;
  const SlipCoefficient slip = slip_coefficient(friction, speed);
  if (stiffness * at.elastic * size <= slip.value * at.normal) {
    t.by_elastic = stiffness * total;
    t.force = at.elastic * t.by_elastic;
    t.by_bristle = at.elastic * stiffness * Square::Identity();
    t.by_sliding = friction.bristle_time * t.by_bristle;
    return t;
  }
  const Vector<double, N> direction = total / size;
  t.by_normal = slip.value * direction;
  t.force = at.normal * t.by_normal;
  t.by_bristle = at.normal * slip.value / size * (Square::Identity() - direction * direction.transpose());
  t.by_sliding = friction.bristle_time * t.by_bristle;
  if (slip.slope != 0.0) t.by_sliding += at.normal * slip.slope / speed * direction * at.sliding.transpose();
  const double carried = slip.value * at.normal / (stiffness * at.elastic);  // |m|, less than |e|
  t.slider_speed = (size - carried) / friction.bristle_time;
  return t;
}

// With m = f z_m/(mu_s p_e), |m| <= |e| along e, p_e dz/dt = p_e (m - z)/tau less G z/2. Then
//   f.w - mu_s/z_m (z.(p_e dz/dt) + (dp_e/dt) z^2/2) = mu_s p_e/(z_m tau) (m.e - 2 m.z + z^2)
//     + mu_s/(2 z_m) (G - dp_e/dt) z^2,
// of which the first part is at least that of (m - z)^2, and the second is not negative.
template <int N>
BristleFlowIn<N> bristle_flow(const MotionFriction& friction, const BristleStateIn<N>& at,
                              const TangentForceIn<N>& f, double elastic_rate) {
  const double time = friction.bristle_time,
               give = friction.bristle_displacement / friction.static_coefficient;
  BristleFlowIn<N> b;
  b.growth_follows = elastic_rate > -at.elastic / time;
  b.growth = std::max(elastic_rate, -at.elastic / time);
  // Where it sticks, f - p_e z mu_s/z_m cancels but for the dashpot.
  const Vector<double, N> moved = f.slider_speed > 0.0
                                      ? Vector<double, N>((give * f.force - at.elastic * at.bristle) / time)
                                      : at.elastic * at.sliding;
  b.flow = moved - 0.5 * b.growth * at.bristle;
  b.heat = f.force.dot(at.sliding) -
           (at.bristle.dot(b.flow) + 0.5 * elastic_rate * at.bristle.squaredNorm()) / give;
  return b;
}

template <int N>
Vector<double, N> flow_change(const MotionFriction& friction, const BristleStateIn<N>& at,
                              const TangentForceIn<N>& f, const BristleFlowIn<N>& flow,
                              const BristleChangeIn<N>& by) {
  const double time = friction.bristle_time,
               give = friction.bristle_displacement / friction.static_coefficient;
  const double growth = flow.growth_follows ? by.elastic_rate : -by.elastic / time;
  return (give * force_change(f, by) - by.elastic * at.bristle - at.elastic * by.bristle) / time -
         0.5 * (growth * at.bristle + flow.growth * by.bristle);
}

// For contact of wires, in the axes of the tangent plane, and of bodies, in space.
template TangentForceIn<2> tangent_force(const MotionFriction&, const BristleStateIn<2>&);
template TangentForceIn<3> tangent_force(const MotionFriction&, const BristleStateIn<3>&);
template BristleFlowIn<2> bristle_flow(const MotionFriction&, const BristleStateIn<2>&,
                                       const TangentForceIn<2>&, double);
template BristleFlowIn<3> bristle_flow(const MotionFriction&, const BristleStateIn<3>&,
                                       const TangentForceIn<3>&, double);
template Vector<double, 2> flow_change(const MotionFriction&, const BristleStateIn<2>&,
                                       const TangentForceIn<2>&, const BristleFlowIn<2>&,
                                       const BristleChangeIn<2>&);
template Vector<double, 3> flow_change(const MotionFriction&, const BristleStateIn<3>&,
                                       const TangentForceIn<3>&, const BristleFlowIn<3>&,
                                       const BristleChangeIn<3>&);

}  // namespace snare::coupling
