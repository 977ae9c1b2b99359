#include "validation/arm_checks.hpp"

#include "base/units.hpp"
#include "multibody/dynamics.hpp"
#include "scenario/arm_scenarios.hpp"
#include "validation/planar_arm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::validation {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using multibody::ArmHistory;
using multibody::ArmSample;
using multibody::DeflectionLaw;
using multibody::Drive;
using multibody::ElasticArm;
using multibody::StiffnessReading;
using std::numbers::pi;

using base::degree;

/// Three links with axes z, y, x, so that nothing stays in a plane; on the world or on a free body of 100 kg.
ElasticArm spatial_arm(bool floating, double stiffness) {
  ElasticArm arm;
  int frame = 0;
  if (floating) {
    frame = arm.tree.add_moving(
        0, "base", multibody::JointKind::free, Vector3d::UnitZ(), {},
        multibody::SpatialInertia::about_centre(100.0, {0.1, 0.0, -0.2}, 40.0 * Eigen::Matrix3d::Identity()));
  }
  for (int i = 0; i < 3; ++i) {
    const multibody::Pose X{Eigen::Matrix3d::Identity(), Vector3d(i == 0 ? 0.0 : 1.0, 0.0, 0.0)};
    frame = arm.tree.add_moving(frame, fmt::format("link {}", i + 1), multibody::JointKind::revolute,
                                Vector3d::Unit((i + 2) % 3), X,
                                multibody::SpatialInertia::about_centre(
                                    10.0, {0.5, 0.05, 0.0}, Vector3d(0.1, 0.9, 0.9).asDiagonal()));
    multibody::ElasticJoint joint;
    joint.name = fmt::format("joint {}", i + 1);
    joint.body = arm.tree.size() - 1;
    joint.motor_inertia = 2.0;
    joint.spring = DeflectionLaw::linear(stiffness, 0.0);
    arm.joints.push_back(joint);
  }
  return arm;
}

/// The mean period of the swings of the first joint, over whole periods [s].
double mean_period(const ArmHistory& history, const ElasticArm& arm) {
  const auto swings = scenario::swings(history, arm, 0);
  const std::size_t n = swings.size() / 2 * 2;
  if (!history.report.usable() || n < 2) return not_computed;
  return 2.0 * (swings[n - 1].end - swings[0].begin) / static_cast<double>(n);
}

Row arm_row(const std::string& name, const std::string& unit, const std::string& source, Kind kind,
            double reference, double value, const Limit& limit) {
  return {"arms", name, unit, source, kind, reference, value, limit};
}

}  // namespace

std::vector<Row> arm_conservation_rows() {
  std::vector<Row> rows;
  {
    auto run = at_rest(spatial_arm(false, 400.0), Drive::locked(), 100.0, 1e-11);
    run.initial.q << 0.3, -0.2, 0.25;
    run.sample = 0.5;
    const ArmHistory history = multibody::simulate(run);
    const double start = history.samples.front().energy;
    double worst = history.report.usable() ? 0.0 : not_computed;
    for (const ArmSample& s : history.samples) worst = std::max(worst, std::abs(s.energy - start) / start);
    rows.push_back(
        arm_row("undamped arm, 100 s: largest change of the energy over the energy", "", "conservation",
                Kind::closed_form, 0.0, worst,
                Limit::absolute(1e-8, "zero reference; the value is a share of the energy at the start")));
  }
  auto run = at_rest(spatial_arm(true, 400.0), Drive::limp(), 10.0, 1e-12);
  run.initial.q.tail<3>() << 0.3, -0.2, 0.25;
  run.initial.v << 0.1, -0.05, 0.2, 0.03, 0.02, -0.04, 0.5, -0.4, 0.3;
  run.sample = 0.1;
  const ArmHistory history = multibody::simulate(run);
  const multibody::Wrench start = history.samples.front().momentum;
  double linear = history.report.usable() ? 0.0 : not_computed;
  double angular = linear;
  for (const ArmSample& s : history.samples) {
    linear = std::max(linear, (s.momentum.force - start.force).norm() / start.force.norm());
    angular = std::max(angular, (s.momentum.moment - start.moment).norm() / start.moment.norm());
  }
  rows.push_back(
      arm_row("floating arm: relative change of the linear momentum a second", "1/s", "conservation",
              Kind::closed_form, 0.0, linear / 10.0,
              Limit::absolute(1e-12, "zero reference; the value is a share of the momentum at the start")));
  rows.push_back(arm_row(
      "floating arm: relative change of the angular momentum a second", "1/s", "conservation",
      Kind::closed_form, 0.0, angular / 10.0,
      Limit::absolute(1e-12, "zero reference; the value is a share of the angular momentum at the start")));
  return rows;
}

// The drives' work is integrated once more from the history, torque times rate by Boole's rule; that of a
// constant force is the force times the way of the tip.
std::vector<Row> arm_work_rows() {
  std::vector<Row> rows;
  const PlanarLink link;
  {
    auto run = at_rest(planar_arm(link, link, 2.0, DeflectionLaw::linear(400.0, 0.0)), Drive{}, 4.0, 1e-10);
    run.drives = {Drive::holding(0.0, 300.0, 40.0), Drive::holding(0.0, 200.0, 30.0)};
    run.drives[0].course = {0.0, 0.8, 0.0, 4.0};
    run.drives[1].course = {0.0, -1.2, 0.0, 4.0};
    run.sample = 4.0 / 4000.0;
    const ArmHistory history = multibody::simulate(run);
    double work = not_computed;
    if (history.report.usable() && history.samples.size() == 4001) {
      work = 0.0;
      constexpr double weight[] = {7.0, 32.0, 12.0, 32.0, 7.0};
      for (std::size_t i = 0; i + 4 < history.samples.size(); i += 4) {
        for (std::size_t k = 0; k < 5; ++k) {
          const ArmSample& s = history.samples[i + k];
          work += 2.0 * run.sample / 45.0 * weight[k] * s.drive_torque.dot(s.state.motor_rate);
        }
      }
    }
    const double change = history.samples.back().energy - history.samples.front().energy;
    rows.push_back(arm_row("change of the energy of a lossless arm under its servos", "J",
                           "work of the drives, from the history", Kind::closed_form, work, change,
                           Limit::relative(1e-6)));
  }
  auto run =
      at_rest(planar_arm(link, link, 2.0, DeflectionLaw::linear(400.0, 0.0)), Drive::limp(), 1.0, 1e-10);
  const int tip = run.arm.tree.find_frame("tip");
  const Vector3d force(-1.0, 4.0, 0.0);
  run.loads.push_back({tip, {Vector3d::Zero(), force}, 0.0, 10.0, multibody::TimedLoad::Shape::constant});
  const ArmHistory history = multibody::simulate(run);
  const auto place_of_tip = [&](const ArmSample& s) {
    const double a = s.state.q[0], b = a + s.state.q[1];
    return Vector3d(link.length * (std::cos(a) + std::cos(b)), link.length * (std::sin(a) + std::sin(b)),
                    0.0);
  };
  const double way = force.dot(place_of_tip(history.samples.back()) - place_of_tip(history.samples.front()));
  rows.push_back(arm_row(
      "work of a constant force at the tip of a limp arm", "J", "force times way", Kind::closed_form, way,
      history.report.usable() ? history.samples.back().work.loads : not_computed, Limit::relative(1e-6)));
  rows.push_back(arm_row("energy that this force gives to the arm", "J", "force times way", Kind::closed_form,
                         way, history.samples.back().energy, Limit::relative(1e-6)));
  return rows;
}

std::vector<Row> arm_frequency_rows() {
  std::vector<Row> rows;
  constexpr double H = 3.0, B = 5.0, K = 200.0, kp = 70.0;
  const auto add = [&rows](const std::string& name, double expected, double value, double limit) {
    rows.push_back(arm_row(name, "Hz", "two masses, closed form", Kind::closed_form, expected, value,
                           Limit::relative(limit)));
  };
  const ElasticArm one = one_joint_arm(H, B, DeflectionLaw::linear(K, 0.0));
  const VectorXd q = VectorXd::Zero(1);
  add("one joint, motor locked", std::sqrt(K / H) / (2.0 * pi),
      multibody::natural_modes(one, q, {Drive::locked()})[0].frequency, 1e-12);
  const double free_pair = std::sqrt(K * (1.0 / H + 1.0 / B)) / (2.0 * pi);
  add("one joint, limp", free_pair, multibody::natural_modes(one, q, {Drive::limp()})[1].frequency, 1e-12);
  // H B x^2 - (K B + (K + kp) H) x + K kp = 0, x = omega^2.
  const double half = 0.5 * (K / H + (K + kp) / B), product = K * kp / (H * B);
  const double root = std::sqrt(half * half - product);
  const auto servo = multibody::natural_modes(one, q, {Drive::holding(0.0, kp, 0.0)});
  add("one joint under a servo, first", std::sqrt(half - root) / (2.0 * pi), servo[0].frequency, 1e-12);
  add("one joint under a servo, second", std::sqrt(half + root) / (2.0 * pi), servo[1].frequency, 1e-12);
  auto run = at_rest(one, Drive::limp(), 5.0, 1e-9);
  run.initial.motor[0] = 0.01;
  add("one joint, limp, in time", free_pair, 1.0 / mean_period(multibody::simulate(run), one), 1e-6);

  // Two links with the motors locked: det(K - w^2 H) = 0 with the textbook's H.
  const PlanarLink first{12.0, 1.2, 0.5, 1.1}, second{7.0, 0.8, 0.35, 0.4};
  const ElasticArm two = planar_arm(first, second, 2.0, DeflectionLaw::linear(K, 0.0));
  const Matrix2d mass = planar_mass(first, second, 0.7);
  const double trace = K * (mass(0, 0) + mass(1, 1)) / mass.determinant(), det = K * K / mass.determinant();
  const double spread = std::sqrt(0.25 * trace * trace - det);
  const auto modes = multibody::natural_modes(two, Vector2d(0.3, 0.7), {Drive::locked(), Drive::locked()});
  add("two links, motors locked, first", std::sqrt(0.5 * trace - spread) / (2.0 * pi), modes[0].frequency,
      1e-10);
  add("two links, motors locked, second", std::sqrt(0.5 * trace + spread) / (2.0 * pi), modes[1].frequency,
      1e-10);
  return rows;
}

// (H + B) q'' + c = tau in the textbook's form by Runge and Kutta, beside ever stiffer gears: the difference
// goes as 1/K.
std::vector<Row> rigid_limit_rows() {
  constexpr double end = 2.0, B = 2.0;
  const PlanarLink link;
  const Vector2d torque(8.0, -4.0);
  const auto acceleration = [&](const Vector2d& q, const Vector2d& v) -> Vector2d {
    return (planar_mass(link, link, q[1]) + B * Matrix2d::Identity()).inverse() *
           (torque - planar_bias(link, link, q[1], v));
  };
  Vector2d q = Vector2d::Zero(), v = q;
  constexpr int steps = 2000;
  constexpr double h = end / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector2d a1 = acceleration(q, v), v2 = v + 0.5 * h * a1, a2 = acceleration(q + 0.5 * h * v, v2);
    const Vector2d v3 = v + 0.5 * h * a2, a3 = acceleration(q + 0.5 * h * v2, v3), v4 = v + h * a3;
    const Vector2d a4 = acceleration(q + h * v3, v4);
    q += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  std::vector<double> differences;
  for (const double K : {1e4, 1e5, 1e6}) {
    // A critical damper lets the gear settle; a servo at its limit is a constant torque.
    auto run = at_rest(planar_arm(link, link, B, DeflectionLaw::linear(K, 2.0 * std::sqrt(2.0 * K))), Drive{},
                       end, 1e-9);
    for (int k = 0; k < 2; ++k) {
      run.drives[static_cast<std::size_t>(k)] =
          Drive::holding(torque[k] > 0.0 ? 1e6 : -1e6, 1.0, 0.0, std::abs(torque[k]));
    }
    const ArmHistory history = multibody::simulate(run);
    differences.push_back(history.report.usable() ? (history.samples.back().state.q - q).norm()
                                                  : not_computed);
  }
  return {arm_row("stiff gears: difference to the rigid arm after 2 s at K = 1e6 N m/rad", "rad",
                  "rigid double pendulum", Kind::independent_code, 0.0, differences[2],
                  Limit::absolute(
                      1e-4,
                      "zero reference: a distance between two solutions; the joints turn by about a radian")),
          arm_row("stiff gears: that difference at K = 1e5 over that at 1e6", "", "first order in 1/K",
                  Kind::closed_form, 10.0, differences[1] / differences[2], Limit::relative(0.05))};
}

// T = 4 int_0^A dx / sqrt(2 (U(A) - U(x))/H), x = A sin s.
std::vector<Row> amplitude_rows() {
  std::vector<Row> rows;
  constexpr double H = 5000.0, k0 = 12.5 / degree, k1 = 475.0 / degree, a = 0.04 * degree;
  const auto energy = [](double x) {
    return x < a ? 0.5 * k0 * x * x : 0.5 * k0 * a * a + (k0 * a + 0.5 * k1 * (x - a)) * (x - a);
  };
  for (const double amplitude : {0.03, 0.041, 0.06, 0.1, 0.5}) {
    const double A = amplitude * degree;
    const auto integrand = [&](double s) {
      const double x = A * std::sin(s);
      return A * std::cos(s) / std::sqrt(2.0 * (energy(A) - energy(x)) / H);
    };
    // The integrand is smooth but for the law's corner.
    const double corner = A > a ? std::asin(a / A) : 0.5 * pi;
    double period = 4.0 * integral(integrand, 0.0, corner, 400);
    if (A > a) period += 4.0 * integral(integrand, corner, 0.5 * pi, 400);
    const ElasticArm arm = one_joint_arm(H, 1.0, table2_law(0.0, StiffnessReading::continuous));
    auto run = at_rest(arm, Drive::locked(), 40.0, 1e-10);
    run.initial.q[0] = A;
    run.tolerances.coordinate = run.tolerances.rate = 1e-13;
    rows.push_back(arm_row(fmt::format("undamped Table 2, period at an amplitude of {:g} deg", amplitude),
                           "s", "quadrature of the energy integral", Kind::closed_form, period,
                           mean_period(multibody::simulate(run), arm), Limit::relative(1e-4)));
  }
  return rows;
}

// A base with one link, all at rest at first: the momentum is zero for ever, so the base's turn follows from
// the link's whatever drives it: th' (I0 + I1 + m (b^2 + l^2 + 2 b l cos q)) + q' (I1 + m (l^2 + b l cos q))
// = 0, m the reduced mass.
std::vector<Row> floating_base_rows() {
  constexpr double m0 = 60.0, I0 = 20.0, b = 0.8, m1 = 25.0, I1 = 4.0, l = 0.9;
  ElasticArm arm;
  const int base = arm.tree.add_moving(
      0, "base", multibody::JointKind::free, Vector3d::UnitZ(), {},
      multibody::SpatialInertia::about_centre(m0, Vector3d::Zero(), I0 * Eigen::Matrix3d::Identity()));
  arm.tree.add_moving(
      base, "link", multibody::JointKind::revolute, Vector3d::UnitZ(),
      {Eigen::Matrix3d::Identity(), {b, 0.0, 0.0}},
      multibody::SpatialInertia::about_centre(m1, {l, 0.0, 0.0}, I1 * Eigen::Matrix3d::Identity()));
  multibody::ElasticJoint joint;
  joint.name = "joint";
  joint.body = 1;
  joint.motor_inertia = 3.0;
  joint.spring = DeflectionLaw::linear(2000.0, 60.0);
  arm.joints.push_back(joint);
  auto run = at_rest(arm, Drive::holding(0.0, 3000.0, 600.0), 12.0, 1e-9);
  run.drives[0].course = {0.0, 2.5, 0.0, 8.0};
  const ArmHistory history = multibody::simulate(run);
  const multibody::ArmState& last = history.samples.back().state;
  const double reduced = m0 * m1 / (m0 + m1), q_end = last.q[7];
  const double turn = integral(
      [&](double q) {
        return -(I1 + reduced * (l * l + b * l * std::cos(q))) /
               (I0 + I1 + reduced * (b * b + l * l + 2.0 * b * l * std::cos(q)));
      },
      0.0, q_end, 50);
  const double found = 2.0 * std::atan2(last.q[6], last.q[3]);
  // The base's centre: minus the link's share of the vector between the two.
  const auto between = [&](double th, double q) {
    return Vector2d(b * std::cos(th) + l * std::cos(th + q), b * std::sin(th) + l * std::sin(th + q));
  };
  const Vector2d moved = -m1 / (m0 + m1) * (between(turn, q_end) - between(0.0, 0.0));
  const double usable = history.report.usable() ? 0.0 : not_computed;
  return {arm_row("floating base: turn after a motion of its link", "rad", "momentum of zero, quadrature",
                  Kind::closed_form, turn, found + usable, Limit::relative(1e-6)),
          arm_row("floating base: way of its centre along x", "m", "centre of mass stays", Kind::closed_form,
                  moved.x(), last.q[0] + usable, Limit::relative(1e-6)),
          arm_row("floating base: way of its centre along y", "m", "centre of mass stays", Kind::closed_form,
                  moved.y(), last.q[1] + usable, Limit::relative(1e-6))};
}

std::vector<Row> jump_rows() {
  std::vector<Row> rows;
  constexpr double inertia = 20000.0, width = 4e-4 * degree;
  struct Case {
    const char* name;
    StiffnessReading reading;
    double width;
  };
  for (const Case& c : {Case{"continuous", StiffnessReading::continuous, 0.0},
                        Case{"literal, jumps", StiffnessReading::literal, 0.0},
                        Case{"literal, narrow ramps", StiffnessReading::literal, width}}) {
    auto run = at_rest(one_joint_arm(inertia, 1.0, table2_law(1.0, c.reading, c.width)), Drive::locked(),
                       60.0, 1e-7);
    run.initial.q[0] = 0.5 * degree;
    run.tolerances.coordinate = run.tolerances.rate = 1e-11;
    const ArmHistory history = multibody::simulate(run);
    const PlainRun plain = swing_on_table2(inertia, 0.5, 60.0, c.reading == StiffnessReading::literal);
    const std::string name = fmt::format("Table 2 ({}), {} kg m^2 let go at 0.5 deg: ", c.name, inertia);
    const double usable = history.report.usable() ? 0.0 : not_computed;
    // A ramp is left at two ends.
    const double events = static_cast<double>(history.events.size()) / (c.width > 0.0 ? 2.0 : 1.0);
    rows.push_back(arm_row(name + "events a passage of a jump, in 60 s", "", "passages by Runge and Kutta",
                           Kind::independent_code, 1.0, events / plain.passages + usable,
                           Limit::relative(1e-12)));
    rows.push_back(arm_row(
        name + "integrator's steps an event", "", "no thrashing", Kind::convergence, 0.0,
        static_cast<double>(history.statistics.steps) / static_cast<double>(history.events.size()) + usable,
        Limit::absolute(60.0, "a bound of the work: any number of steps below it is fine")));
  }
  // A load of 10 N m between the torques of the literal jump (0.5 and 19 N m): Filippov's solution rests at
  // the jump.
  constexpr double at_jump = 0.04 * degree;
  for (const double w : {width, 0.1 * width}) {
    auto run = at_rest(one_joint_arm(0.01 * inertia, 1.0, table2_law(1.0, StiffnessReading::literal, w)),
                       Drive::locked(), 20.0, 1e-7);
    run.tolerances.coordinate = run.tolerances.rate = 1e-12;
    run.loads.push_back(
        {1, {{0.0, 0.0, 10.0}, Vector3d::Zero()}, 0.0, 1e3, multibody::TimedLoad::Shape::constant});
    const ArmHistory history = multibody::simulate(run);
    const double usable = history.report.usable() ? 0.0 : not_computed;
    const std::string name =
        fmt::format("10 N m on a literal jump of Table 2, ramp of {:g} deg: ", w / degree);
    rows.push_back(arm_row(name + "deflection at rest", "deg", "Filippov: at the jump", Kind::closed_form,
                           at_jump / degree, history.samples.back().deflection[0] / degree + usable,
                           Limit::relative(0.5 * w / at_jump)));
    rows.push_back(arm_row(name + "torque at rest", "N m", "the load", Kind::closed_form, 10.0,
                           history.samples.back().joint_torque[0] + usable, Limit::relative(1e-3)));
    rows.push_back(
        arm_row(name + "integrator's steps in 20 s", "", "no thrashing", Kind::convergence, 0.0,
                static_cast<double>(history.statistics.steps) + usable,
                Limit::absolute(10000.0, "a bound of the work: any number of steps below it is fine")));
  }
  return rows;
}

std::vector<Row> joint_step_rows(const std::filesystem::path& arms) {
  std::vector<Row> rows;
  multibody::ArmDescription arm = multibody::read_arm(arms / "jemrms_like.toml");
  const VectorXd pose = arm.poses.front().angles;
  {
    // One joint on Table 2, the others nearly rigid: the first two vibrations are four swings.
    multibody::ArmDescription stiff = arm;
    for (std::size_t k = 1; k < stiff.arm.joints.size(); ++k)
      stiff.arm.joints[k].spring = DeflectionLaw::linear(1e9, 1e6);
    auto run = scenario::joint_step(stiff, pose, 0, 0.5 * degree, 60.0);
    run.ida.relative_tolerance = 1e-8;
    const ArmHistory history = multibody::simulate(run);
    const auto found = scenario::swings(history, stiff.arm, 0);
    multibody::DynamicsWorkspace workspace(stiff.arm.tree);
    const double inertia = multibody::mass_matrix(stiff.arm.tree, run.initial.q, workspace)(0, 0);
    const auto expected = swing_on_table2(inertia, -0.5, 60.0, false).swings;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool there = history.report.usable() && i < found.size() && i < expected.size();
      const std::string name = fmt::format("JEMRMS joint step of 0.5 deg, swing {}: ", i + 1);
      rows.push_back(arm_row(name + "end", "s", "Table 2 by Runge and Kutta", Kind::independent_code,
                             there ? expected[i].end : 1.0, there ? found[i].end : not_computed,
                             Limit::relative(1e-3)));
      rows.push_back(arm_row(name + "frequency", "Hz", "Table 2 by Runge and Kutta", Kind::independent_code,
                             there ? 0.5 / (expected[i].end - expected[i].begin) : 1.0,
                             there ? found[i].frequency() : not_computed, Limit::relative(1e-3)));
      rows.push_back(arm_row(name + "peak", "deg", "Table 2 by Runge and Kutta", Kind::independent_code,
                             there ? expected[i].peak : 1.0, there ? found[i].peak / degree : not_computed,
                             Limit::relative(1e-3)));
    }
    const bool there = !found.empty() && found.size() == expected.size();
    rows.push_back(arm_row(
        "JEMRMS joint step: last frequency over the first", "", "Table 2 by Runge and Kutta",
        Kind::independent_code,
        there ? (expected[0].end - expected[0].begin) / (expected.back().end - expected.back().begin) : 1.0,
        there ? found.back().frequency() / found.front().frequency() : not_computed, Limit::relative(5e-3)));
  }
  // All six joints on Table 2 as printed: loads hold joints at the jump for a while.
  for (multibody::ElasticJoint& joint : arm.arm.joints)
    joint.spring = table2_law(1.0, StiffnessReading::literal, 4e-4 * degree);
  for (std::size_t k = 0; k < 3; ++k) {
    auto run = scenario::joint_step(arm, arm.poses.back().angles, static_cast<int>(k), 0.5 * degree, 60.0);
    run.ida.relative_tolerance = 1e-6;
    run.tolerances.coordinate = run.tolerances.rate = 1e-8;
    const ArmHistory history = multibody::simulate(run);
    const std::string name = fmt::format("literal Table 2 at all six joints, step of joint {}: ", k + 1);
    rows.push_back(arm_row(name + "time reached", "s", "to the end", Kind::convergence, 60.0,
                           history.samples.back().time, Limit::relative(1e-11)));
    rows.push_back(
        arm_row(name + "events in 60 s", "", "no thrashing", Kind::convergence, 0.0,
                static_cast<double>(history.events.size()),
                Limit::absolute(2000.0, "a bound of the work: any number of events below it is fine")));
    rows.push_back(
        arm_row(name + "steps an event", "", "no thrashing", Kind::convergence, 0.0,
                static_cast<double>(history.statistics.steps) /
                    std::max<double>(1.0, static_cast<double>(history.events.size())),
                Limit::absolute(100.0, "a bound of the work: any number of steps below it is fine")));
    rows.push_back(
        arm_row(name + "energy balance", "", "conservation", Kind::closed_form, 0.0, history.energy_error,
                Limit::absolute(1e-3, "zero reference; the value is a share of the largest energy or work")));
  }
  return rows;
}

std::vector<Row> tip_push_rows(const std::filesystem::path& arms) {
  std::vector<Row> rows;
  multibody::ArmDescription arm = multibody::read_arm(arms / "ssrms_like.toml");
  const VectorXd pose = arm.poses[1].angles;
  const int n = arm.arm.motors();
  // Held by its servos it comes back; with the brakes off it drifts away.
  for (const auto hold : {scenario::Hold::as_described, scenario::Hold::limp}) {
    auto run = scenario::tip_impulse(arm, pose, hold, {0.0, 200.0, 0.0}, 0.5, 60.0);
    run.sample = 0.1;
    const ArmHistory history = multibody::simulate(run);
    const double usable = history.report.usable() ? 0.0 : not_computed;
    const double away = (history.samples.back().state.q - history.samples.front().state.q).norm() + usable;
    if (hold == scenario::Hold::as_described) {
      rows.push_back(
          arm_row("SSRMS held by its servos, 60 s after 200 N s at the tip: joints away", "rad", "comes back",
                  Kind::closed_form, 0.0, away,
                  Limit::absolute(1e-3, "zero reference; the angles of the arm's pose are about a radian")));
    }
    rows.push_back(
        arm_row(fmt::format("SSRMS {} after 200 N s at the tip: energy balance",
                            hold == scenario::Hold::limp ? "limp" : "held"),
                "", "conservation", Kind::closed_form, 0.0, history.energy_error + usable,
                Limit::absolute(1e-4, "zero reference; the value is a share of the largest energy or work")));
  }
  // Limp without friction. A push much shorter than the gears' periods moves the links alone: E = p H^-1 p/2,
  // p = J^T P; when the gears have come to rest links and motors turn together: E = p (H + B)^-1 p/2.
  for (multibody::ElasticJoint& joint : arm.arm.joints) {
    joint.friction = {};
    joint.back_drive = 0.0;
  }
  const Vector3d impulse(0.0, 0.5, 0.3);
  auto run = scenario::tip_impulse(arm, pose, scenario::Hold::limp, impulse, 1e-5, 30.0);
  run.ida.relative_tolerance = 1e-9;
  run.tolerances = {1e-13, 1e-13};
  const ArmHistory history = multibody::simulate(run);
  multibody::Kinematics kinematics(arm.arm.tree);
  multibody::place(arm.arm.tree, run.initial.q, kinematics);
  const VectorXd p =
      multibody::frame_jacobian(arm.arm.tree, kinematics, arm.tip).bottomRows<3>().transpose() * impulse;
  multibody::DynamicsWorkspace workspace(arm.arm.tree);
  Eigen::MatrixXd mass = multibody::mass_matrix(arm.arm.tree, run.initial.q, workspace);
  const double links = 0.5 * p.dot(mass.ldlt().solve(p));
  for (int k = 0; k < n; ++k) {
    const multibody::ElasticJoint& joint = arm.arm.joints[static_cast<std::size_t>(k)];
    const int i = arm.arm.tree.body(joint.body).v_index;
    mass(i, i) += joint.motor_inertia;
  }
  const double usable = history.report.usable() ? 0.0 : not_computed;
  rows.push_back(arm_row("SSRMS limp without friction, 0.58 N s in 10 us at the tip: work of the push", "J",
                         "p H^-1 p/2, H of this code", Kind::closed_form, links,
                         history.samples.back().work.loads + usable, Limit::relative(1e-3)));
  rows.push_back(arm_row("the same 30 s later: energy left", "J", "p (H + B)^-1 p/2, H of this code",
                         Kind::closed_form, 0.5 * p.dot(mass.ldlt().solve(p)),
                         history.samples.back().energy + usable, Limit::relative(1e-2)));
  return rows;
}

std::vector<Check> arm_checks(const std::filesystem::path& arms) {
  return {{"energy and momentum of arms", arm_conservation_rows},
          {"work on arms", arm_work_rows},
          {"frequencies of elastic joints", arm_frequency_rows},
          {"rigid limit of elastic joints", rigid_limit_rows},
          {"period against amplitude", amplitude_rows},
          {"floating base", floating_base_rows},
          {"jumps of Table 2", jump_rows},
          {"joint step of the JEMRMS", [arms] { return joint_step_rows(arms); }},
          {"push at the tip of the SSRMS", [arms] { return tip_push_rows(arms); }}};
}

}  // namespace snare::validation
