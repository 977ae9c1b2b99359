// Random small wires struck by a body with a ball, with and without friction: the motion as `snare simulate`
// integrates it, against contact written a second time (referee_contact.hpp) and integrated by an explicit
// Runge-Kutta method of Boost.

#include "coupling/contact/shape.hpp"
#include "tests/slow/referee_contact.hpp"
#include "tests/slow/referee_motion.hpp"

#include <memory>

namespace snare::referee {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

struct StrikeProblem {
  PlanarProblem planar;
  Striker striker;
  StrikerState body;
  double lever = 0.0;  ///< by which angles and spins of the body count as places and speeds
};

/// A ball of a twentieth of the wire's length beside its middle part, that meets it within a third of the
/// time.
StrikeProblem random_strike(Draws& draw) {
  StrikeProblem s;
  PlanarProblem& p = s.planar;
  do {
    p = random_planar_wire(draw);
  } while (p.wire.left.kind == EndKind::free || p.wire.right.kind == EndKind::free);
  p.duration *= 0.5;
  const PlanarWire& w = p.wire;
  const double length = w.length();
  Striker& b = s.striker;
  b.radius = length * draw.of_any_size(0.02, 0.06);
  b.wire_radius = b.radius * draw.of_any_size(0.05, 0.3);
  b.mass = length * w.mass_per_length * draw.of_any_size(0.3, 10.0);
  b.inertia = b.mass * std::pow(b.radius * draw.between(0.5, 2.0), 2);
  const double far = draw.between(-2.0, 2.0) * b.radius;
  b.offset = {far, draw.between(-2.0, 2.0) * b.radius};
  s.lever = b.offset.norm() + b.radius;
  const double speed = draw.of_any_size(0.03, 0.5) * length * p.slowest;
  b.damping = draw.of_any_size(0.03, 3.0) / speed;
  // The force that bends the wire by a tenth presses it in by this share of the radius.
  const double depth = b.radius * draw.of_any_size(1e-4, 1e-2), force = 10.0 * w.bending / (length * length);
  b.modulus = force / (4.0 / 3.0 * std::sqrt(2.0 * (b.radius + b.wire_radius)) * std::pow(depth, 1.5));
  if (draw.chance(0.7)) {
    Rubbing& r = b.rubbing;
    r.law = draw.chance(0.5) ? Rubbing::Law::bristles : Rubbing::Law::smooth;
    r.resting = draw.between(0.1, 0.8);
    r.sliding = r.resting * draw.between(0.4, 1.0);
    r.resting_speed = speed * draw.of_any_size(0.03, 0.3);
    r.sliding_speed = r.resting_speed * draw.of_any_size(3.0, 30.0);
    r.give = b.radius * draw.of_any_size(1e-3, 3e-2);
    r.time = r.give / speed * draw.of_any_size(0.3, 3.0);
  }
  // Beside the wire at a random place of its middle part, on either side.
  const auto i = static_cast<std::size_t>(draw.between(0.35, 0.65) * static_cast<double>(w.edges()));
  const Vector2 chord = p.x[i + 1] - p.x[i], along = chord.normalized();
  const Vector2 normal = (draw.chance(0.5) ? 1.0 : -1.0) * Vector2(-along.y(), along.x());
  const Vector2 at = p.x[i] + draw.between(0.0, 1.0) * chord;
  s.body.angle = draw.between(-pi, pi);
  const double direction = draw.between(-0.5, 0.5);
  s.body.velocity = speed * (Eigen::Rotation2Dd(direction) * Vector2(-normal)) + p.v[i];
  s.body.spin = draw.between(-1.0, 1.0) * speed / s.lever;
  double gap = speed * p.duration * draw.between(0.05, 0.3);
  for (bool clear = false; !clear; gap += 0.1 * b.radius) {
    const Vector2 centre = at + (b.radius + b.wire_radius + gap) * normal;
    s.body.place = centre - Eigen::Rotation2Dd(s.body.angle) * b.offset;
    clear = true;
    for (std::size_t e = 0; e < w.edges(); ++e) {
      for (int k = 0; k <= 20; ++k) {
        const Vector2 point = p.x[e] + 0.05 * k * (p.x[e + 1] - p.x[e]);
        // The curve leaves the chords of these wires by less than a tenth of an edge.
        clear = clear && (point - centre).norm() > b.radius + b.wire_radius + 0.1 * w.rest[e];
      }
    }
  }
  return s;
}

std::string described(const StrikeProblem& s) {
  const Striker& b = s.striker;
  const Rubbing& r = b.rubbing;
  const char* law = r.law == Rubbing::Law::none     ? "no friction"
                    : r.law == Rubbing::Law::smooth ? "smooth"
                                                    : "bristles";
  return fmt::format(
      "ball of {:.9g} m at ({:.9g} {:.9g}) in a body of {:.9g} kg, {:.9g} kg m^2, at ({:.9g} {:.9g}), turned "
      "by "
      "{:.9g}, moving at "
      "({:.9g} {:.9g}), {:.9g} rad/s, wire's radius {:.9g} m, foundation {:.9g} N/m^2, {:.9g} s/m, {} {:.6g} "
      "{:.6g} "
      "{:.6g} {:.6g} "
      "{:.6g} {:.6g}; wire: {}",
      b.radius, b.offset.x(), b.offset.y(), b.mass, b.inertia, s.body.place.x(), s.body.place.y(),
      s.body.angle, s.body.velocity.x(), s.body.velocity.y(), s.body.spin, b.wire_radius, b.modulus,
      b.damping, law, r.resting, r.sliding, r.resting_speed, r.sliding_speed, r.give, r.time,
      described(s.planar));
}

/// Equations of motion of wire and body. State: places of the wire, of the body, its angle times the lever;
/// as many velocities; bristles; impulse on the wire.
class StrikeEquations {
 public:
  explicit StrikeEquations(const StrikeProblem& s)
      : problem_(s),
        forces_(s.planar.wire),
        contact_(s.planar.wire, s.striker),
        x_(s.planar.x),
        v_(x_),
        f_(x_) {}

  void rate(const State& state, State& rates) {
    const PlanarWire& w = problem_.planar.wire;
    const Striker& b = problem_.striker;
    const std::size_t n = w.vertices(), places = 2 * n + 3;
    const StrikerState body = read(state);
    const std::vector<double> bristles(state.begin() + static_cast<std::ptrdiff_t>(2 * places),
                                       state.begin() + static_cast<std::ptrdiff_t>(2 * places + n));
    std::fill(f_.begin(), f_.end(), Vector2(0.0, 0.0));
    forces_.add(x_, v_, f_);
    const ContactForces contact = contact_.add(x_, v_, body, bristles, f_);
    nearest_mount = std::min(nearest_mount, contact.nearest_mount);
    for (std::size_t i = 0; i < n; ++i) f_[i] = w.holds(i) ? Vector2(0.0, 0.0) : Vector2(f_[i] / w.mass(i));
    rates.assign(state.begin() + static_cast<std::ptrdiff_t>(places),
                 state.begin() + static_cast<std::ptrdiff_t>(2 * places));
    append(rates, f_);
    append(rates, std::vector<Vector2>{w.gravity - contact.on_wire / b.mass});
    rates.push_back(contact.moment / b.inertia * problem_.lever);
    rates.insert(rates.end(), contact.bristle_rates.begin(), contact.bristle_rates.end());
    append(rates, std::vector<Vector2>{contact.on_wire});
  }

  /// A third of the way to the first touch, at speeds that no point of either exceeds by much.
  double longest_step(const State& state) {
    const StrikerState body = read(state);
    const double gap = contact_.next_gap(x_, body);
    double speed = body.velocity.norm() + std::abs(body.spin) * problem_.lever;
    double of_wire = 0.0;
    for (const Vector2& v : v_) of_wire = std::max(of_wire, v.norm());
    speed += of_wire;
    return std::max(gap / (3.0 * speed), 1e-6 * problem_.planar.duration);
  }

  double nearest_mount =
      std::numeric_limits<double>::infinity();  ///< way from what has touched to a mount [m]

 private:
  StrikerState read(const State& state) {
    const std::size_t n = x_.size(), places = 2 * n + 3;
    take(state, 0, x_);
    take(state, places, v_);
    StrikerState body;
    body.place = {state[2 * n], state[2 * n + 1]};
    body.angle = state[2 * n + 2] / problem_.lever;
    body.velocity = {state[places + 2 * n], state[places + 2 * n + 1]};
    body.spin = state[places + 2 * n + 2] / problem_.lever;
    return body;
  }

  const StrikeProblem& problem_;
  PlanarForces forces_;
  PlanarContact contact_;
  Places x_, v_, f_;
};

coupling::Motion simulated(const StrikeProblem& s) {
  const PlanarProblem& p = s.planar;
  const Striker& b = s.striker;
  coupling::Motion motion;
  motion.gravity = p.plane.point(p.wire.gravity);
  motion.wires.push_back(simulated_wire(p));
  coupling::MotionBody body;
  body.properties.mass = b.mass;
  body.properties.inertia = Vector3d(0.7, 0.8, 1.0).asDiagonal();
  body.properties.inertia *= b.inertia;
  body.start.position = p.plane.point(s.body.place);
  body.start.orientation =
      Eigen::Quaterniond(p.plane.axes) * Eigen::AngleAxisd(s.body.angle, Vector3d::UnitZ());
  body.start.velocity = p.plane.point(s.body.velocity);
  body.start.spin = {0.0, 0.0, s.body.spin};
  motion.bodies.push_back(body);
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::Ball>(b.radius);
  contact.X_BS.p = {b.offset.x(), b.offset.y(), 0.0};
  contact.wire_radius = b.wire_radius;
  contact.foundation = {b.modulus, b.damping};
  const Rubbing& r = b.rubbing;
  if (r.law != Rubbing::Law::none) {
    contact.friction = {r.resting,
                        r.sliding,
                        r.resting_speed,
                        r.sliding_speed,
                        r.law == Rubbing::Law::smooth ? coupling::ContactFriction::smooth
                                                      : coupling::ContactFriction::stick_slip,
                        r.give,
                        r.time};
  }
  motion.contacts.push_back(contact);
  return motion;
}

/// Normal forces of samples are those of a polynomial through the last steps.
constexpr double force_share = 1e-3;

Verdict judge_strike(const StrikeProblem& s) {
  const PlanarProblem& p = s.planar;
  const std::size_t n = p.wire.vertices(), places = 2 * n + 3;
  const double mass = s.striker.mass + p.wire.mass_per_length * p.wire.length();
  State start;
  append(start, p.x);
  append(start, std::vector<Vector2>{s.body.place});
  start.push_back(s.body.angle * s.lever);
  append(start, p.v);
  append(start, std::vector<Vector2>{s.body.velocity});
  start.push_back(s.body.spin * s.lever);
  start.resize(2 * places + n + 2, 0.0);
  double nearest = std::numeric_limits<double>::infinity();
  const auto equations = [&]() -> Equations {
    const auto shared = std::make_shared<StrikeEquations>(s);
    return {[shared, &nearest](const State& state, State& rates, double) {
              shared->rate(state, rates);
              nearest = std::min(nearest, shared->nearest_mount);
            },
            [shared](const State& state) { return shared->longest_step(state); }};
  };
  const Reference reference(
      equations, start, places, [&](std::size_t k) { return k >= 2 * n || !p.wire.holds(k / 2); },
      p.duration);
  coupling::MotionOptions options;
  options.duration = p.duration;
  const PlanarContact contact(p.wire, s.striker);
  double angle = s.body.angle, largest_force = 0.0, of_force = 0.0;
  Vector2 impulse = Vector2::Zero();
  Verdict v = judged(
      reference, simulated(s), options,
      [&](const coupling::MotionSample& sample) {
        Places x, rates, forces(n, Vector2(0.0, 0.0));
        sample_wire(p, sample, x, rates);
        const multibody::RigidBodyState& b = sample.bodies[0];
        const Eigen::Matrix3d turned = p.plane.axes.transpose() * b.orientation.toRotationMatrix();
        angle += std::remainder(std::atan2(turned(1, 0), turned(0, 0)) - angle, 2.0 * pi);
        const StrikerState body{p.plane.seen(b.position), p.plane.seen(b.velocity), angle, b.spin.z()};
        const double force =
            contact.add(x, rates, body, State(n, 0.0), forces).normal;  // without its friction
        largest_force = std::max(largest_force, force);
        of_force = std::max(of_force, std::abs(sample.contacts[0].normal_force - force));
        State state;
        append(state, x);
        append(state, std::vector<Vector2>{body.place});
        state.push_back(body.angle * s.lever);
        append(state, rates);
        append(state, std::vector<Vector2>{body.velocity});
        state.push_back(body.spin * s.lever);
        return state;
      },
      [&](const coupling::MotionResult& result) {
        if (!result.impulse.empty()) impulse = p.plane.seen(result.impulse[0]);
        return std::numeric_limits<double>::infinity();
      });
  v.text +=
      fmt::format("; normal forces differ by up to {:.2e} of {:.4g} N from the law", of_force, largest_force);
  if (largest_force > 0.0) raise(v.of_limit, of_force / (force_share * largest_force));
  const State& end = reference.states.back();
  const Vector2 expected(end[end.size() - 2], end[end.size() - 1]);
  if (v.last + 1 == reference.states.size()) {
    const double difference = (impulse - expected).norm();
    v.text +=
        fmt::format("; impulse {:.6g} {:.6g} N s, differs by {:.2e}", expected.x(), expected.y(), difference);
    raise(v.of_limit, difference / (v.allowed * reference.speed * mass));
  }
  // The law of mounts, which a ball near them meets, is not written here (M.35).
  const double of_mount = std::max(s.striker.radius + s.striker.wire_radius, 8.0 * s.striker.wire_radius);
  v.counts = nearest > of_mount && expected != Vector2(0.0, 0.0);
  return v;
}

TEST(SlowReferees, RandomStrikesMoveAsASecondIntegratorSays) {
  judge_all<StrikeProblem>(24, random_strike, judge_strike);
}

}  // namespace
}  // namespace snare::referee
