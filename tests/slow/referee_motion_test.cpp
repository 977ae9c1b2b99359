// Random small wires in motion: places and velocities as `snare simulate` integrates them, against equations
// written a second time (referee_wire.hpp, referee_spatial_wire.hpp) and integrated by an explicit
// Runge-Kutta method of Boost.

#include "tests/slow/referee_motion.hpp"
#include "tests/slow/referee_spatial_wire.hpp"

namespace snare::referee {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

Verdict judge_planar(const PlanarProblem& p) {
  State start;
  append(start, p.x);
  append(start, p.v);
  const std::size_t n = p.wire.vertices();
  const auto equations = [&p, n]() -> Equations {
    const auto rate = [&w = p.wire, n, forces = PlanarForces(p.wire), x = p.x, v = p.v, f = p.v](
                          const State& s, State& rates, double) mutable {
      take(s, 0, x);
      take(s, 2 * n, v);
      std::fill(f.begin(), f.end(), Vector2(0.0, 0.0));
      forces.add(x, v, f);
      for (std::size_t i = 0; i < n; ++i) f[i] = w.holds(i) ? Vector2(0.0, 0.0) : Vector2(f[i] / w.mass(i));
      rates.clear();
      append(rates, v);
      append(rates, f);
    };
    return {rate, {}};
  };
  const Reference reference(
      equations, start, 2 * n, [&](std::size_t k) { return !p.wire.holds(k / 2); }, p.duration);
  coupling::Motion motion;
  motion.gravity = p.plane.point(p.wire.gravity);
  motion.wires.push_back(simulated_wire(p));
  coupling::MotionOptions options;
  options.duration = p.duration;
  return judged(reference, motion, options, [&](const coupling::MotionSample& s) {
    Places x, v;
    sample_wire(p, s, x, v);
    State state;
    append(state, x);
    append(state, v);
    return state;
  });
}

/// A wire in space, its ends held in all ways, twisted by up to a radian.
struct SpatialProblem {
  SpatialWire wire;
  std::vector<Vector3> x, v;
  double duration = 0.0, grading = 0.0;
};

SpatialProblem random_spatial_wire(Draws& draw) {
  SpatialProblem p;
  SpatialWire& w = p.wire;
  const double length = draw.of_any_size(0.05, 1.0), square = length * length;
  const int edges = draw.count(4, 9);
  p.grading = draw.chance(0.3) ? draw.between(0.3, 1.5) : 0.0;
  w.rest = graded_edges(length, edges, p.grading);
  w.mass_per_length = draw.of_any_size(1e-3, 0.1);
  w.bending = draw.of_any_size(1e-4, 0.1);
  w.torsional = w.bending * draw.of_any_size(0.3, 3.0);
  w.axial = w.bending / square * draw.of_any_size(1e3, 1e4);
  const double slowest = 5.0 / square * std::sqrt(w.bending / w.mass_per_length);
  if (draw.chance(0.5)) w.axial_time = draw.of_any_size(1e-4, 1e-2) / slowest;
  if (draw.chance(0.3)) w.mass_rate = draw.of_any_size(1e-2, 1.0) * slowest;
  if (draw.chance(0.3)) w.natural_twist = draw.between(-1.0, 1.0) / length;
  const auto between = [&](double size) {
    const double x = draw.between(-size, size), y = draw.between(-size, size);
    return Vector3(x, y, draw.between(-size, size));
  };
  if (draw.chance(0.5)) w.gravity = between(0.1 * length * slowest * slowest);
  const auto kind = [&](SpatialWireEnd& end) {
    end.kind = draw.one_of<EndKind>({EndKind::clamp, EndKind::clamp, EndKind::pin, EndKind::free});
    end.holds_twist = end.kind == EndKind::clamp || (end.kind == EndKind::pin && draw.chance(0.5));
  };
  kind(w.left);
  kind(w.right);
  if (!w.left.holds_twist) std::swap(w.left, w.right);  // a single end that holds the twist is the left one
  p.duration = draw.between(0.3, 0.8) * 2.0 * pi / slowest;

  const Eigen::Matrix3d axes = random_turn(draw);
  const Vector3 bow = between(0.5), wave = between(0.5);
  const auto tangent = [&](double s) {
    return (axes * (Vector3::UnitX() + std::sin(2.0 * s) * bow + std::cos(pi * s) * wave)).normalized();
  };
  const double strain = draw.between(-10.0, 10.0) * w.bending / square / w.axial;
  const Vector3 first = between(0.1 * length * slowest), second = between(0.1 * length * slowest);
  const double from = w.left.kind == EndKind::free ? 0.5 : 0.0,
               to = w.right.kind == EndKind::free ? 0.5 : 1.0;
  Vector3 place = between(0.1 * length);
  double s = 0.0;
  for (std::size_t i = 0; i < w.vertices(); ++i) {
    p.x.push_back(place);
    const Vector3 v = std::sin(pi * (from + (to - from) * s / length)) * first +
                      std::sin(pi * (from + (to - from + 1.0) * s / length)) * second;
    p.v.push_back(w.holds(i) ? Vector3(0.0, 0.0, 0.0) : v);
    if (i == w.edges()) break;
    place += w.rest[i] * (1.0 + strain) * tangent((s + 0.5 * w.rest[i]) / length);
    s += w.rest[i];
  }
  w.left.direction = (tangent(0.0) + between(0.05)).normalized();
  w.right.direction = (tangent(1.0) + between(0.05)).normalized();
  w.left.director = w.left.direction.unitOrthogonal();
  // Carried along, and turned.
  Complex3 at = complex3(w.left.direction), director = complex3(w.left.director);
  for (std::size_t e = 0; e <= w.edges(); ++e) {
    const Complex3 next = unit(complex3(e < w.edges() ? Vector3(p.x[e + 1] - p.x[e]) : w.right.direction));
    director = carried(director, at, next);
    at = next;
  }
  w.right.director = Eigen::AngleAxisd(draw.between(-1.0, 1.0), w.right.direction) *
                     Vector3(director[0].real(), director[1].real(), director[2].real());
  return p;
}

std::string described(const SpatialProblem& p) {
  const SpatialWire& w = p.wire;
  const auto v3 = [](const Vector3& a) { return fmt::format("({:.9g} {:.9g} {:.9g})", a.x(), a.y(), a.z()); };
  const auto end = [&](const SpatialWireEnd& e) {
    return fmt::format("{}{} {} {}", name_of(e.kind), e.holds_twist ? " with twist" : "", v3(e.direction),
                       v3(e.director));
  };
  std::string text = fmt::format(
      "{} edges, grading {:.9g}, EI {:.9g}, GJ {:.9g}, EA {:.9g}, natural twist {:.9g}, {:.9g} kg/m, damping "
      "{:.9g} "
      "{:.9g}, gravity {}, {} to {}, {:.9g} s, edges and start",
      w.edges(), p.grading, w.bending, w.torsional, w.axial, w.natural_twist, w.mass_per_length, w.axial_time,
      w.mass_rate, v3(w.gravity), end(w.left), end(w.right), p.duration);
  for (std::size_t i = 0; i < p.x.size(); ++i)
    text += fmt::format(" {:.9g} {}; {}", i < w.edges() ? w.rest[i] : 0.0, v3(p.x[i]), v3(p.v[i]));
  return text;
}

Verdict judge_spatial(const SpatialProblem& p) {
  const SpatialWire& w = p.wire;
  const std::size_t n = w.vertices();
  State start;
  append(start, p.x);
  append(start, p.v);
  const auto equations = [&p, n]() -> Equations {
    const auto rate = [&w = p.wire, n, x = p.x, v = p.v, f = p.v](const State& s, State& rates,
                                                                  double) mutable {
      take(s, 0, x);
      take(s, 3 * n, v);
      std::fill(f.begin(), f.end(), Vector3(0.0, 0.0, 0.0));
      add_spatial_forces(w, x, v, f);
      for (std::size_t i = 0; i < n; ++i)
        f[i] = w.holds(i) ? Vector3(0.0, 0.0, 0.0) : Vector3(f[i] / w.mass(i));
      rates.clear();
      append(rates, v);
      append(rates, f);
    };
    return {rate, {}};
  };
  const Reference reference(
      equations, start, 3 * n, [&](std::size_t k) { return !w.holds(k / 3); }, p.duration);

  wire::RodInMotion rod;
  for (const double h : w.rest) rod.length += h;
  rod.elements = static_cast<int>(w.edges());
  rod.grading = p.grading;
  rod.mass_per_length = w.mass_per_length;
  rod.damping = {0.0, w.axial_time, w.mass_rate};
  wire::SpatialRodProperties& properties = rod.properties;
  properties.bending_stiffness = properties.second_bending_stiffness = w.bending;
  properties.torsional_stiffness = w.torsional;
  properties.axial_stiffness = w.axial;
  properties.natural_twist = w.natural_twist;
  const auto end = [](const SpatialWireEnd& e, const Vector3& at) {
    wire::SpatialEnd s;
    s.kind = e.kind == EndKind::pin && e.holds_twist ? wire::SpatialEnd::Kind::twisting_pin
                                                     : simulated_kind(e.kind);
    s.position = at;
    s.direction = e.direction;
    s.director = e.director;
    return s;
  };
  properties.left = end(w.left, p.x.front());
  properties.right = end(w.right, p.x.back());
  coupling::Motion motion;
  motion.gravity = w.gravity;
  motion.wires.push_back({"wire",
                          rod,
                          Eigen::Matrix3Xd::Map(start.data(), 3, static_cast<Eigen::Index>(n)),
                          Eigen::Matrix3Xd::Map(start.data() + 3 * n, 3, static_cast<Eigen::Index>(n)),
                          {},
                          {}});
  coupling::MotionOptions options;
  options.duration = p.duration;
  return judged(reference, motion, options, [&](const coupling::MotionSample& s) {
    State state(s.wires[0].data(), s.wires[0].data() + s.wires[0].size());
    const Eigen::Matrix3Xd& v = s.wire_loads[0].velocities;
    state.insert(state.end(), v.data(), v.data() + v.size());
    return state;
  });
}

TEST(SlowReferees, RandomWiresMoveAsASecondIntegratorSays) {
  judge_all<PlanarProblem>(60, random_planar_wire, judge_planar);
}

TEST(SlowReferees, RandomWiresInSpaceMoveAsASecondIntegratorSays) {
  judge_all<SpatialProblem>(60, random_spatial_wire, judge_spatial);
}

}  // namespace
}  // namespace snare::referee
