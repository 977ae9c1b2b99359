#include "reduction/impact_damping.hpp"

#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "scenario/mount_reader.hpp"
#include "scenario/push_law.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace snare::reduction {

namespace {

constexpr double start_distance = 1e-4;  // of the pusher from first touch [m]
// half periods of mass and secant stiffness within which it must have left
constexpr double most_periods = 40.0;
constexpr int steps_a_half_period = 2000;
constexpr int samples_a_half_period = 200;

/// Half a period of the mass on the secant stiffness at the travel where the law has taken up its energy, the
/// longest that counts [s].
double half_period(const numerics::HermiteCurve& law, double mass, double speed) {
  const double energy = 0.5 * mass * speed * speed;
  const double end = law.knots().back();
  double travel = end;
  for (const double d : law.knots()) {
    if (law.integral(d) < energy) continue;
    travel = d;
    break;
  }
  const double absorbed = std::max(law.integral(travel), 1e-3 * energy);
  const double stiffness = 2.0 * absorbed / (travel * travel);
  return std::numbers::pi * std::sqrt(mass / stiffness);
}

}  // namespace

LawRebound rebound(const numerics::HermiteCurve& law, double damping, double mass, double speed) {
  const double end = law.knots().back();
  const auto force = [&](double d, double rate) {
    if (d < 0.0 || (d == 0.0 && rate <= 0.0)) return 0.0;
    const double spring = d <= end ? law.value(d) : law.value(end) + law.slope(end) * (d - end);
    return std::max(0.0, spring + damping * rate);
  };
  // The dashpot alone stops the mass in some m/c.
  double step = half_period(law, mass, speed) / steps_a_half_period;
  if (damping > 0.0) step = std::min(step, 0.02 * mass / damping);
  LawRebound result;
  double d = 0.0;
  double v = speed;
  const long most_steps = static_cast<long>(most_periods) * steps_a_half_period * 100;
  for (long n = 0; n < most_steps; ++n) {
    const double a1 = -force(d, v) / mass;
    const double v2 = v + 0.5 * step * a1;
    const double a2 = -force(d + 0.5 * step * v, v2) / mass;
    const double v3 = v + 0.5 * step * a2;
    const double a3 = -force(d + 0.5 * step * v2, v3) / mass;
    const double v4 = v + step * a3;
    const double a4 = -force(d + step * v3, v4) / mass;
    d += step / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    result.peak_force = std::max(result.peak_force, -mass * a1);
    result.largest_travel = std::max(result.largest_travel, d);
    if (v >= 0.0) continue;
    // No force any more, and none to come: it leaves.
    if (d <= 0.0 || a4 == 0.0) {
      result.restitution = -v / speed;
      return result;
    }
  }
  return result;  // creeps back without end
}

double damping_of_restitution(const numerics::HermiteCurve& law, double restitution, double mass,
                              double speed) {
  if (rebound(law, 0.0, mass, speed).restitution <= restitution) return 0.0;
  double high = 1e-3 * mass / half_period(law, mass, speed);
  double low = 0.0;
  while (rebound(law, high, mass, speed).restitution > restitution) {
    low = high;
    high *= 4.0;
  }
  while (high - low > 1e-10 * high) {
    const double middle = 0.5 * (low + high);
    (rebound(law, middle, mass, speed).restitution > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

namespace {

/// The mounts of a push as those of a wire in a scenario.
scenario::WireMounts mounts_of(const wire::MountSpecification& mount) {
  scenario::WireMounts mounts;
  mounts.kind = mount.kind == wire::MountKind::clamped ? wire::SpatialEnd::Kind::clamp
                                                       : wire::SpatialEnd::Kind::twisting_pin;
  for (std::size_t k = 0; k < 2; ++k) {
    mounts.give[k].stiffness = mount.translational_stiffness_of(k);
    mounts.rotational_stiffness[k] = mount.rotational_stiffness_of(k);
  }
  return mounts;
}

/// Holds the only wire by mounts of the motion where they give along the chord, in place of springs of its
/// own.
void add_mounts(const scenario::WireMounts& mounts, coupling::Motion& motion) {
  coupling::MotionWire& held = motion.wires.front();
  for (const wire::End which : wire::ends) {
    coupling::MotionMount mount;
    mount.give = mounts.give[index_of(which)];
    if (!mount.give.gives()) continue;
    held.rod.properties.end(which).translational_stiffness = std::numeric_limits<double>::infinity();
    mount.name = held.name + (which == wire::End::left ? " left mount" : " right mount");
    mount.end = which;
    motion.mounts.push_back(mount);
  }
}

/// A body whose centre of mass is on the pusher's axis moves along the push towards the wire at rest.
coupling::Motion meeting(const coupling::PushProblem& test, const ImpactSettings& settings, double speed,
                         double side) {
  wire::RodInMotion rod = wire::rod_in_motion(test.wire, test.mount.span, settings.elements);
  const scenario::WireMounts mounts = mounts_of(test.mount);
  mounts.set(rod.properties);
  rod.damping = settings.damping;
  const Eigen::Matrix3Xd rest = coupling::resting_wire(rod);
  const double wire_radius = 0.5 * test.wire.diameter;
  const double touch =
      scenario::first_touch(rest, test.pusher.radius + wire_radius, side).value(test.contact_position);
  coupling::Motion motion;
  motion.gravity = {test.gravity[0], test.gravity[1], test.gravity[2]};
  motion.wires.push_back({"wire", rod, rest, {}, {}});
  add_mounts(mounts, motion);
  coupling::MotionBody body;
  body.properties.mass = 2.0 * settings.mass;
  body.properties.inertia = settings.mass * Eigen::Matrix3d::Identity();
  body.start.position = {test.contact_position, side * (touch - start_distance), 0.0};
  body.start.velocity = {0.0, side * speed, 0.0};
  motion.bodies.push_back(body);
  coupling::MotionContact contact;
  contact.name = "wire";
  contact.shape = std::make_shared<coupling::EndlessCylinder>(test.pusher.radius);
  contact.wire_radius = wire_radius;
  contact.friction = {test.pusher.friction, test.pusher.friction, 0.01, 1.0};
  motion.contacts.push_back(contact);
  return motion;
}

/// Adds the mirror image of the only wire, about the plane x = `position`, with a contact of its own: the
/// body then feels no force across the push, as on a slide. Its mass has to be twice that on one wire.
void add_mirror_image(coupling::Motion& motion, double position) {
  coupling::MotionWire image = motion.wires.front();
  image.name = "mirrored wire";
  wire::SpatialEnd& left = image.rod.properties.left;
  wire::SpatialEnd& right = image.rod.properties.right;
  const double span = right.position.x();
  std::swap(left.rotational_stiffness, right.rotational_stiffness);
  left.position.x() = 2.0 * position - span;
  right.position.x() = 2.0 * position;
  image.positions = image.positions.rowwise().reverse().eval();
  image.positions.row(0) = (2.0 * position - image.positions.row(0).array()).matrix();
  motion.wires.push_back(image);
  for (coupling::MotionMount mount : std::vector(motion.mounts)) {
    mount.name = "mirrored " + mount.name;
    mount.wire = 1;
    mount.end = mount.end == wire::End::left ? wire::End::right : wire::End::left;
    motion.mounts.push_back(mount);
  }
  coupling::MotionContact contact = motion.contacts.front();
  contact.name = "mirrored contact";
  contact.wire = 1;
  motion.contacts.push_back(contact);
}

}  // namespace

ImpactDamping distil_impact(const coupling::PushProblem& test, const ImpactSettings& settings, double speed,
                            const numerics::HermiteCurve& loading, numerics::SolveReport& report) {
  const double side = test.pusher.direction == coupling::PushDirection::outward ? 1.0 : -1.0;
  const double half = half_period(loading, settings.mass, speed);
  coupling::MotionOptions options;
  options.duration = most_periods * half + 4.0 * start_distance / speed;
  options.output_interval = half / samples_a_half_period;
  // What the integrator loses must be little beside what the wire does.
  options.relative_tolerance = 1e-6;
  options.position_tolerance = 1e-9;
  options.velocity_tolerance = 1e-6;
  options.max_step = 0.2 * (test.pusher.radius + 0.5 * test.wire.diameter) / speed;

  coupling::Motion motion = meeting(test, settings, speed, side);
  add_mirror_image(motion, test.contact_position);
  const double start = motion.bodies.front().start.position.y();
  ImpactDamping result;
  result.speed = speed;
  bool left = false;
  double farthest = 0.0;
  const coupling::MotionResult run =
      coupling::simulate(motion, options, [&](const coupling::MotionSample& s) {
        const multibody::RigidBodyState& body = s.bodies.front();
        const double way = side * (body.position.y() - start);
        farthest = std::max(farthest, way);
        // Behind where it came from and going: the wire no longer reaches it.
        left = way < 0.0 && side * body.velocity.y() < 0.0;
        if (!left) return false;
        result.restitution = -side * body.velocity.y() / speed;
        return true;
      });
  if (!run.report.usable() && !left) {
    report.termination = run.report.termination;
    report.message = run.report.message;
    return result;
  }
  result.integrator_loss = -run.energy.integrator / (settings.mass * speed * speed);
  result.peak_force = run.peak_force.front();
  result.largest_travel = std::max(0.0, farthest - start_distance);
  if (!run.events.empty()) result.duration = run.events.back().time - run.events.front().time;
  if (!left || result.largest_travel > loading.knots().back()) return result;
  result.damping = damping_of_restitution(loading, result.restitution, settings.mass, speed);
  result.law_peak_force = rebound(loading, *result.damping, settings.mass, speed).peak_force;
  return result;
}

}  // namespace snare::reduction
