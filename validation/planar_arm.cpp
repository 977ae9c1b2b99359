#include "validation/planar_arm.hpp"

#include "base/units.hpp"

#include <cmath>
#include <numbers>

namespace snare::validation {

using multibody::DeflectionLaw;
using multibody::ElasticArm;

namespace {

using base::degree;

void add_joint(ElasticArm& arm, double motor_inertia, const DeflectionLaw& law) {
  multibody::ElasticJoint joint;
  joint.name = "joint " + std::to_string(arm.joints.size() + 1);
  joint.body = arm.tree.size() - 1;
  joint.motor_inertia = motor_inertia;
  joint.spring = law;
  arm.joints.push_back(joint);
}

}  // namespace

Eigen::Matrix2d planar_mass(const PlanarLink& a, const PlanarLink& b, double q2) {
  const double cross = b.mass * a.length * b.centre * std::cos(q2);
  const double h22 = b.inertia + b.mass * b.centre * b.centre;
  const double h11 =
      a.inertia + a.mass * a.centre * a.centre + b.mass * a.length * a.length + h22 + 2.0 * cross;
  Eigen::Matrix2d H;
  H << h11, h22 + cross, h22 + cross, h22;
  return H;
}

Eigen::Vector2d planar_bias(const PlanarLink& a, const PlanarLink& b, double q2,
                            const Eigen::Vector2d& rate) {
  const double h = b.mass * a.length * b.centre * std::sin(q2);
  return {-h * (2.0 * rate[0] * rate[1] + rate[1] * rate[1]), h * rate[0] * rate[0]};
}

ElasticArm planar_arm(const PlanarLink& first, const PlanarLink& second, double motor_inertia,
                      const DeflectionLaw& law) {
  ElasticArm arm;
  int frame = 0;
  double reach = 0.0;
  for (const PlanarLink* link : {&first, &second}) {
    const Eigen::Vector3d moments(0.1 * link->inertia, link->inertia, link->inertia);
    frame = arm.tree.add_moving(
        frame, frame == 0 ? "first" : "second", multibody::JointKind::revolute, Eigen::Vector3d::UnitZ(),
        {Eigen::Matrix3d::Identity(), {reach, 0.0, 0.0}},
        multibody::SpatialInertia::about_centre(link->mass, {link->centre, 0.0, 0.0}, moments.asDiagonal()));
    reach = link->length;
    add_joint(arm, motor_inertia, law);
  }
  arm.tree.add_fixed(frame, "tip", {Eigen::Matrix3d::Identity(), {second.length, 0.0, 0.0}});
  return arm;
}

ElasticArm one_joint_arm(double link_inertia, double motor_inertia, const DeflectionLaw& law) {
  ElasticArm arm;
  arm.tree.add_moving(0, "link", multibody::JointKind::revolute, Eigen::Vector3d::UnitZ(), {},
                      multibody::SpatialInertia::about_centre(1.0, Eigen::Vector3d::Zero(),
                                                              link_inertia * Eigen::Matrix3d::Identity()));
  add_joint(arm, motor_inertia, law);
  return arm;
}

multibody::ArmScenario at_rest(const ElasticArm& arm, const multibody::Drive& drive, double end,
                               double tolerance) {
  multibody::ArmScenario s;
  s.arm = arm;
  s.initial = multibody::resting(arm, multibody::zero_state(arm.tree).q);
  s.drives.assign(arm.joints.size(), drive);
  s.end = end;
  s.ida.relative_tolerance = tolerance;
  s.tolerances = {tolerance, tolerance};
  return s;
}

DeflectionLaw table2_law(double damping_factor, multibody::StiffnessReading reading, double jump_width) {
  return DeflectionLaw({{0.0, 12.5 / degree, damping_factor * 48.9 / degree, 0.0},
                        {0.04 * degree, 475.0 / degree, damping_factor * 87.3 / degree, 0.0},
                        {0.06 * degree, 475.0 / degree, damping_factor * 17.6 / degree, 0.0}},
                       reading, multibody::DampingRate::deflection, jump_width);
}

double table2_torque(double degrees, bool literal) {
  const double size = std::abs(degrees);
  const double outer = literal ? 475.0 * size : 0.5 + 475.0 * (size - 0.04);
  return (degrees < 0.0 ? -1.0 : 1.0) * (size < 0.04 ? 12.5 * size : outer);
}

double table2_damping(double degrees) {
  const double size = std::abs(degrees);
  return size < 0.04 ? 48.9 : (size < 0.06 ? 87.3 : 17.6);
}

PlainRun swing_on_table2(double inertia, double start, double end, bool literal) {
  constexpr double h = 2e-5;
  const auto acceleration = [&](double d, double v) {
    return -(table2_torque(d, literal) + table2_damping(d) * v) / degree / inertia;
  };
  const auto piece = [](double d) { return (std::abs(d) >= 0.04 ? 1 : 0) + (std::abs(d) >= 0.06 ? 1 : 0); };
  PlainRun run;
  double d = start, v = 0.0, zero = -1.0, peak = 0.0;
  for (long i = 0; static_cast<double>(i) * h < end; ++i) {
    const double a1 = acceleration(d, v), v2 = v + 0.5 * h * a1, a2 = acceleration(d + 0.5 * h * v, v2);
    const double v3 = v + 0.5 * h * a2, a3 = acceleration(d + 0.5 * h * v2, v3), v4 = v + h * a3;
    const double a4 = acceleration(d + h * v3, v4), before = d;
    d += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    run.passages += std::abs(piece(d) - piece(before));
    if (std::abs(d) > std::abs(peak)) peak = d;
    if ((d < 0.0) != (before < 0.0)) {
      const double now = (static_cast<double>(i) + before / (before - d)) * h;
      if (zero >= 0.0) run.swings.push_back({zero, now, peak});
      zero = now;
      peak = 0.0;
    }
  }
  return run;
}

}  // namespace snare::validation
