#include "validation/snare_checks.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "multibody/arm/course.hpp"
#include "validation/scenario_run.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

namespace snare::validation {

namespace {

using base::at;
using coupling::MotionCarrier;
using Eigen::Vector3d;

Row snare_row(const std::string& name, const std::string& unit, const std::string& source, Kind kind,
              double reference, double value, const Limit& limit) {
  return {"capture", name, unit, source, kind, reference, value, limit};
}

/// A machine that takes a point round the z axis: the mount of a wire, on no ring.
coupling::MotionBody machine(const std::string& name, const Vector3d& start,
                             const multibody::Course& course) {
  coupling::MotionBody body;
  body.name = name;
  body.driven = true;
  body.start.position = start;
  const auto at_time = [start, course](double time) -> Vector3d {
    return Eigen::AngleAxisd(course.angle(time) - course.angle(0.0), Vector3d::UnitZ()) * start;
  };
  body.course_velocity = [=](double time) -> Vector3d {
    return course.rate(time) * Vector3d::UnitZ().cross(at_time(time));
  };
  body.course_acceleration = [=](double time) -> Vector3d {
    const Vector3d r = at_time(time), across = Vector3d::UnitZ().cross(r);
    return course.acceleration(time) * across +
           course.rate(time) * course.rate(time) * Vector3d::UnitZ().cross(across);
  };
  return body;
}

/// A third of the default tolerances, those of positions in proportion to the size of the end effector: two
/// similar tests differ by the error of the integrator alone.
std::vector<std::string> finer(double size) {
  return {"solver.relative_tolerance=3e-7",
          "solver.velocity_tolerance_m_s=1e-3",
          "solver.quasi_static_velocity_tolerance_m_s=3e-5",
          "solver.body_velocity_tolerance_m_s=3e-7",
          "solver.body_angle_tolerance_rad=3e-8",
          "solver.body_spin_tolerance_rad_s=3e-6",
          fmt::format("solver.position_tolerance_m={}", size * 1e-7),
          fmt::format("solver.body_position_tolerance_m={}", size * 3e-9)};
}

/// What changes the shipped constraint test into that of the end effector of twice the size, at the same
/// speeds and stresses:
/// lengths and times by 2, masses and torques by 8, and so on.                                         (M.34)
std::vector<std::string> twice_as_large() {
  std::vector<std::string> settings{
      "duration_s=19.8",
      "output_interval_s=0.02",
      "damping.bending_time_s=2.0e-3",
      "damping.axial_time_s=2.0e-4",
      "snares[snare].ring_radius_mm=100.0",
      "snares[snare].ring.inertia_kg_m2=0.064",
      "snares[snare].ring.motor_inertia_kg_m2=0.16",
      "snares[snare].ring.stiffness_Nm_rad=8.0e5",
      "snares[snare].ring.damping_Nms_rad=1600.0",
      "snares[snare].wire.diameter_mm=1.5",
      "snares[snare].wire.length_mm=200.0",
      "snares[snare].wire.axial_stiffness_N=5.0e4",
      "snares[snare].wire.bending_stiffness_Nm2=5.0e-3",
      "snares[snare].wire_contact.bristle_displacement_m=2.0e-6",
      "snares[snare].wire_contact.bristle_time_s=2.0e-5",
      "arms[robot].base_mm=[0.0,0.0,240.0]",
      "bodies[probe].mass_kg=4.0",
      "bodies[probe].inertia_kg_m2=[0.032,0.032,0.032]",
      "bushings[sensor].translational_stiffness_N_m=2.0e7",
      "bushings[sensor].rotational_stiffness_Nm_rad=8.0e5",
      "bushings[sensor].translational_damping_Ns_m=4.0e3",
      "bushings[sensor].rotational_damping_Nms_rad=160.0",
      "shapes[pin].position_mm=[0.0,0.0,-240.0]",
      "shapes[pin].radius_mm=6.0",
      "shapes[pin].length_mm=200.0",
      "shapes[pin].bristle_displacement_m=2.0e-6",
      "shapes[pin].bristle_time_s=2.0e-5",
      "phases[close].at_s=0.1",
      "phases[close].drives[1].duration_s=1.6",
  };
  double begin = 1.8;
  for (const char axis : {'x', 'y', 'z'}) {
    const double way = axis == 'z' ? 20.0 : 6.0;
    for (const int leg : {1, 2, 3}) {
      const std::string phase = fmt::format("phases[{}{}].", axis, leg);
      const double duration = leg == 2 ? 3.0 : 1.5;
      settings.push_back(fmt::format("{}at_s={:.1f}", phase, begin));
      settings.push_back(fmt::format("{}drives[1].duration_s={:.1f}", phase, duration));
      settings.push_back(fmt::format("{}drives[1].by_mm={:.1f}", phase, leg == 2 ? -2.0 * way : way));
      begin += duration;
    }
  }
  return settings;
}

}  // namespace

// The joint's gear is so stiff that the ring is where its motor is: 5 N m turn it by 5e-9 rad.
std::vector<Row> ring_two_ways_rows(const std::filesystem::path& data, const std::string& model) {
  scenario::NamedMotion by_joint =
      motion_of(data / "scenarios/snare_on_pin.toml",
                {fmt::format("snares[snare].wire.model=\"{}\"", model),
                 "shapes[pin].position_mm=[0.3,0.1,0.0]", "snares[snare].ring.stiffness_Nm_rad=1.0e9",
                 "snares[snare].ring.damping_Nms_rad=1.0e5", "damping.axial_time_s=1.0e-3"});
  // A course whose rate has no kinks: the machines' places are integrated.
  const multibody::Course course(140.0 * base::degree, 178.0 * base::degree, 0.05, 0.9);
  by_joint.motion.phases.clear();
  by_joint.motion.arms.front().drives = {multibody::Drive::on_course(course)};
  // A place that errs by 1e-7 m is worth 0.1 N of a taut wire.
  coupling::MotionOptions& o = by_joint.options;
  for (double* tolerance :
       {&o.body_position_tolerance, &o.body_velocity_tolerance, &o.angle_tolerance, &o.spin_tolerance})
    *tolerance *= 1e-3;
  for (double* tolerance : {&o.relative_tolerance, &o.position_tolerance, &o.quasi_static_velocity_tolerance})
    *tolerance *= 0.1;
  scenario::NamedMotion by_machines = by_joint;
  coupling::Motion& motion = by_machines.motion;
  motion.arms.front().drives = {multibody::Drive::locked()};
  motion.arms.front().drives.front().course = multibody::Course::standing(course.from);
  const auto take = [&](const std::string& wire, const Vector3d& mount) {
    motion.bodies.push_back(machine(wire + " machine", mount, course));
    return MotionCarrier{MotionCarrier::Kind::body, static_cast<int>(motion.bodies.size()) - 1, 0};
  };
  for (coupling::LawWire& w : motion.law_wires) w.to = take(w.name, w.p_to);
  for (coupling::MotionMount& m : motion.mounts) {
    if (m.end != wire::End::right) continue;
    const coupling::MotionWire& w = motion.wires[at(m.wire)];
    m.carrier = take(w.name, w.rod.properties.right.position);
  }
  const ScenarioRun joint = run_motion(by_joint), machines = run_motion(by_machines);
  const double usable = joint.usable() + machines.usable();
  const std::string source = "mounts moved by courses of their own, without a ring";
  std::vector<Row> rows;
  const std::vector<coupling::WireFacts> wires = by_joint.motion.wire_facts();
  // Contacts of the wires with the pin, which come first, or where laws stand for the wires alone.
  for (std::size_t k = 0; k < wires.size(); ++k) {
    const std::string name = fmt::format("ring as a joint, {} wires, {}: ", model, wires[k].name);
    rows.push_back(snare_row(name + "tension", "N", source, Kind::convergence,
                             coupling::end_tension(machines.last, k),
                             coupling::end_tension(joint.last, k) + usable, Limit::relative(1e-4)));
    rows.push_back(snare_row(name + "peak force on the pin", "N", source, Kind::convergence,
                             machines.result.peak_force[k], joint.result.peak_force[k] + usable,
                             Limit::relative(1e-4)));
    rows.push_back(snare_row(name + "impulse on the pin", "N s", source, Kind::convergence,
                             machines.result.impulse[k].norm(), joint.result.impulse[k].norm() + usable,
                             Limit::relative(1e-4)));
  }
  return rows;
}

// The arm's end counts as 50 kg, 200 kg m^2 at 2 m; its spring does next to nothing in the 0.15 s of the
// contact.
std::vector<Row> bench_rows(const std::filesystem::path& data) {
  constexpr double k = 1.0e4, m = 40.0, speed = 0.05, pi = 3.14159265358979323846;
  const auto restitution = [&](double delay, bool fixed) {
    std::vector<std::string> settings{fmt::format("bodies[robot].robot.delay_s={}", delay), "duration_s=0.4"};
    if (fixed) settings.emplace_back("arms[mockup].every_joint.stiffness_Nm_rad=1.0e12");
    double leaves = 0.0;
    const ScenarioRun run =
        run_of(data / "scenarios/bench_in_the_loop.toml", settings, [&](const coupling::MotionSample& s) {
          const double tip = 2.0 * s.arms[0].state.v[0] * std::cos(s.arms[0].state.q[0]);
          leaves = std::max(leaves, tip - s.bodies[0].velocity.y());
        });
    return leaves / speed + run.usable();
  };
  std::vector<Row> rows;
  for (const double delay : {0.001, 0.002, 0.004}) {
    const std::string name = fmt::format("hardware in the loop, {:g} ms late, restitution ", 1e3 * delay);
    rows.push_back(snare_row(name + "on a rigid arm", "", "exp(pi omega tau/2)", Kind::closed_form,
                             std::exp(0.5 * pi * std::sqrt(k / m) * delay), restitution(delay, true),
                             Limit::relative(0.02)));
    const double omega = std::sqrt(k * (1.0 / m + 1.0 / 50.0));
    rows.push_back(snare_row(name + "on a passive arm", "", "exp(pi k tau/(2 m omega))", Kind::closed_form,
                             std::exp(pi * k * delay / (2.0 * m * omega)), restitution(delay, false),
                             Limit::relative(0.02)));
  }
  return rows;
}

// Smooth friction mu(s)/s with mu(s) = mu x (3 - x^2)/2, x = s/s_static, below the static speed (M.9): the
// shaft creeps where it is the pull over the sum of the normal forces.
std::vector<Row> held_shaft_rows(const std::filesystem::path& data) {
  struct Course {
    double least = 1e9, most = -1e9, at_60 = 0.0, at_120 = 0.0, normal = 0.0;
  };
  const auto held = [&](const std::string& law) {
    Course c;
    const ScenarioRun run = run_of(data / "scenarios/held_shaft.toml", {"shapes[pin].law=\"" + law + "\""},
                                   [&](const coupling::MotionSample& s) {
                                     if (s.time < 59.99) return;
                                     const double z = s.arms[0].state.q[0];  // of the slide
                                     c.least = std::min(c.least, z);
                                     c.most = std::max(c.most, z);
                                     if (s.time < 60.01) c.at_60 = z;
                                     c.at_120 = z;
                                     c.normal = 0.0;
                                     for (std::size_t k = 0; k < 3; ++k)
                                       c.normal += s.contacts[k].normal_force;
                                   });
    c.at_120 += run.usable();
    c.most += run.usable();
    return c;
  };
  const Course sticks = held("stick_slip"), creeps = held("smooth");
  constexpr double pull = 5.0, friction = 0.3, static_speed = 1e-4;
  double x = 0.0;
  for (int k = 0; k < 60; ++k) x = 2.0 * pull / (friction * creeps.normal) / (3.0 - x * x);
  return {
      snare_row("shaft held by three wires, way from 60 to 120 s, stick_slip", "m", "rests",
                Kind::closed_form, 0.0, sticks.most - sticks.least,
                Limit::absolute(1e-5, "zero reference; the smooth law creeps by the way of the next row")),
      snare_row("shaft held by three wires, way from 60 to 120 s, smooth", "m", "mu N x (3 - x^2)/2 = F",
                Kind::closed_form, 60.0 * static_speed * x, creeps.at_120 - creeps.at_60,
                Limit::relative(0.05))};
}

// Sliding back through the middle along its axis, the pin feels nothing but the friction of what the wires
// press it with.
std::vector<Row> constraint_test_rows(const std::filesystem::path& data) {
  struct Reading {
    multibody::Wrench sensor;
    double normal = 0.0;
  };
  const auto test = [&](double size, std::vector<std::string> settings, std::vector<Reading>& readings) {
    std::ranges::copy(finer(size), std::back_inserter(settings));
    return run_of(data / "scenarios/constraint_test.toml", settings, [&](const coupling::MotionSample& s) {
      Reading r{s.bushings.front().on_second, 0.0};
      for (std::size_t k = 0; k < 3; ++k) r.normal += s.contacts[k].normal_force;
      readings.push_back(r);
    });
  };
  std::vector<Reading> half, full;
  const double usable = test(1.0, {}, half).usable() + test(2.0, twice_as_large(), full).usable();
  constexpr double nothing = 1e-300;  // where nothing was computed
  double force = 0.0, moment = 0.0, most_force = nothing, most_moment = nothing;
  const std::size_t common = std::min(half.size(), full.size());
  for (std::size_t i = 0; i < common; ++i) {
    const multibody::Wrench &small = half[i].sensor, &large = full[i].sensor;
    force = std::max(force, (large.force - 4.0 * small.force).norm());
    moment = std::max(moment, (large.moment - 8.0 * small.moment).norm());
    most_force = std::max(most_force, large.force.norm());
    most_moment = std::max(most_moment, large.moment.norm());
  }
  constexpr std::size_t middle = 840;  // of the way back along z: 8.40 s
  constexpr double friction = 0.1;
  const Reading sliding = half.size() > middle ? half[middle] : Reading{};
  const std::string source = "similarity of all terms at the same speeds and stresses";
  return {snare_row("constraint test at full scale, force less 4 times that at half, over its peak", "",
                    source, Kind::convergence, 0.0, force / most_force + usable,
                    Limit::absolute(2e-3, "zero reference; the value is a share of the peak force")),
          snare_row("constraint test at full scale, moment less 8 times that at half, over its peak", "",
                    source, Kind::convergence, 0.0, moment / most_moment + usable,
                    Limit::absolute(2e-3, "zero reference; the value is a share of the peak moment")),
          snare_row("constraint test, force along the pin as it slides through the middle", "N", "mu sum N",
                    Kind::closed_form, friction * sliding.normal, std::abs(sliding.sensor.force.z()) + usable,
                    Limit::relative(1e-3))};
}

std::vector<Check> snare_checks(const std::filesystem::path& data) {
  std::vector<Check> checks;
  for (const char* model : {"stretched", "quasi_static"})
    checks.push_back({fmt::format("ring two ways, {}", model),
                      [data, model = std::string(model)] { return ring_two_ways_rows(data, model); }});
  checks.push_back({"held shaft", [data] { return held_shaft_rows(data); }});
  checks.push_back({"constraint test", [data] { return constraint_test_rows(data); }});
  checks.push_back({"hardware in the loop", [data] { return bench_rows(data); }});
  return checks;
}

}  // namespace snare::validation
