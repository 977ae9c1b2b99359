#pragma once

#include "coupling/dynamics/run/simulate.hpp"
#include "tests/slow/referee_draws.hpp"
#include "tests/slow/referee_wire.hpp"

#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

// What the referees of motions have in common: the second integrator, random wires, and how far two
// integrations may differ.
namespace snare::referee {

/// Places, as many velocities, then what else is integrated.
using State = std::vector<double>;
using Rate = std::function<void(const State&, State&, double)>;

/// Samples of a motion, the start included.
inline constexpr int intervals = 40;
/// Relative and absolute tolerance of a step of the reference, and where only the growth of a change of 1e-6
/// counts.
inline constexpr double reference_tolerance = 1e-11, rough_tolerance = 1e-9;
/// What a step of the simulation may err by, as a share of the way and of the speed.
inline constexpr double step_tolerance = 1e-8;
/// Beyond this growth of a change at the start two integrations need not agree.
inline constexpr double largest_growth = 1e4;

/// Equations of motion.
struct Equations {
  Rate rate;
  /// The longest step from a state [s]: what is about to touch is not passed by; empty: any.
  std::function<double(const State&)> longest_step;
};

/// States at evenly spaced times, by the explicit method of Runge, Kutta and Fehlberg of order 8.
inline std::vector<State> integrated(const Equations& equations, State state, double end, double tolerance) {
  namespace odeint = boost::numeric::odeint;
  auto stepper = odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_fehlberg78<State>());
  std::vector<State> states{state};
  double time = 0.0, step = 1e-7 * end;
  for (int k = 1; k <= intervals; ++k) {
    const double to = end * k / intervals;
    while (time < to) {
      const double longest = equations.longest_step ? equations.longest_step(state) : end;
      double taken = std::min({step, longest, to - time});
      const bool last = taken == to - time, limited = taken < step;
      const double tried = taken;
      bool succeeded = false;
      try {
        succeeded = stepper.try_step(equations.rate, state, time, taken) == odeint::success;
      } catch (const NoBalance&) {  // a stage where there is no balance
        if (taken < 1e-12 * end) throw;
        taken *= 0.5;
      }
      if (succeeded && last) time = to;
      if (!(succeeded && limited && taken >= tried))
        step = taken;  // a short last step says nothing of the next one
    }
    states.push_back(state);
  }
  return states;
}

/// To the larger value; what is no number stays.
inline void raise(double& value, double other) {
  if (!(other <= value) && !std::isnan(value)) value = other;
}

/// A reference motion with its scales.
struct Reference {
  std::vector<State> states;
  double way = 0.0, speed = 0.0;  ///< how far anything goes, and how fast
  /// By how much a small change of the start has grown up to each sample: errors of steps grow as it does.
  std::vector<double> growth;

  [[nodiscard]] std::size_t places() const { return places_; }

  /// moves: whether a place is free.
  Reference(const std::function<Equations()>& equations, const State& start, std::size_t places,
            const std::function<bool(std::size_t)>& moves, double end)
      : states(integrated(equations(), start, end, reference_tolerance)), places_(places) {
    for (const State& s : states) {
      for (std::size_t i = 0; i < places; ++i) {
        way = std::max(way, std::abs(s[i] - start[i]));
        speed = std::max(speed, std::abs(s[places + i]));
      }
    }
    constexpr double change = 1e-6;
    State beside = start;
    for (std::size_t i = 0; i < places; ++i) {
      if (!moves(i)) continue;
      beside[i] += (i % 4 < 2 ? change : -change) * way;
      beside[places + i] += (i % 3 == 0 ? change : -change) * speed;
    }
    const std::vector<State> other = integrated(equations(), beside, end, rough_tolerance);
    double largest = 0.0;
    for (std::size_t k = 0; k < states.size(); ++k) {
      largest = std::max({largest, difference(states[k], other[k], 0) / change,
                          difference(states[k], other[k], 1) / change});
      growth.push_back(largest);
    }
  }

  /// Largest difference of places (0) or velocities (1), as a share of the way or of the speed.
  [[nodiscard]] double difference(const State& a, const State& b, std::size_t which) const {
    double d = 0.0;
    for (std::size_t i = 0; i < places_; ++i)
      raise(d, std::abs(a[which * places_ + i] - b[which * places_ + i]));
    return d / (which == 0 ? way : speed);
  }

 private:
  std::size_t places_;
};

/// What came of one problem.
struct Verdict {
  double of_limit = 0.0;                  ///< largest difference over what is allowed [-]
  double places = 0.0, velocities = 0.0;  ///< largest differences, as shares of way and speed [-]
  std::size_t last = 0;                   ///< sample up to which they were compared
  double allowed = 0.0;                   ///< there [-]
  bool counts = true;                     ///< there was something to compare
  std::string text;
};

/// Simulates and compares. sampled: places and velocities of a sample; end: time from which on the two need
/// not agree [s].
inline Verdict judged(
    const Reference& reference, const coupling::Motion& motion, coupling::MotionOptions options,
    const std::function<State(const coupling::MotionSample&)>& sampled,
    const std::function<double(const coupling::MotionResult&)>& end = [](const coupling::MotionResult&) {
      return std::numeric_limits<double>::infinity();
    }) {
  options.output_interval = options.duration / intervals;
  options.relative_tolerance = step_tolerance;
  options.position_tolerance = options.body_position_tolerance = step_tolerance * reference.way;
  options.velocity_tolerance = options.body_velocity_tolerance = step_tolerance * reference.speed;
  options.twist_tolerance = options.angle_tolerance = options.spin_tolerance = step_tolerance;
  options.max_order = 5;
  options.newton_share = 1e-3;
  options.wire_loads = true;
  std::vector<State> states;
  const coupling::MotionResult result =
      coupling::simulate(motion, options, [&](const coupling::MotionSample& s) {
        states.push_back(sampled(s));
        return false;
      });
  Verdict v;
  if (states.size() < reference.states.size() - 1) v.of_limit = std::numeric_limits<double>::infinity();
  const double until = end(result);
  for (std::size_t k = 0; k < states.size() && reference.growth[k] < largest_growth; ++k) {
    if (options.output_interval * static_cast<double>(k) > until) break;
    // Each step may err by its tolerance.
    v.allowed = static_cast<double>(result.statistics.steps) * step_tolerance * reference.growth[k];
    const double places = reference.difference(states[k], reference.states[k], 0);
    const double velocities = reference.difference(states[k], reference.states[k], 1);
    raise(v.places, places);
    raise(v.velocities, velocities);
    raise(v.of_limit, std::max(places, velocities) / v.allowed);
    if (std::isnan(places + velocities)) v.of_limit = std::numeric_limits<double>::quiet_NaN();
    v.last = k;
  }
  v.text = fmt::format(
      "places differ by {:.2e} of the way {:.4g} m, velocities by {:.2e} of {:.4g} m/s up to sample {}, "
      "{:.2e} of "
      "the limit; {} steps, growth {:.3g} {}",
      v.places, reference.way, v.velocities, reference.speed, v.last, v.of_limit, result.statistics.steps,
      reference.growth[v.last], result.report.message);
  return v;
}

/// A plane in space: its first two axes, and the third across it.
struct Plane {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  [[nodiscard]] Eigen::Vector3d point(const Vector2& p) const { return axes.leftCols<2>() * p; }
  [[nodiscard]] Vector2 seen(const Eigen::Vector3d& p) const { return axes.leftCols<2>().transpose() * p; }
};

inline Eigen::Matrix3d random_turn(Draws& draw) {
  std::normal_distribution<double> normal;
  auto& random = draw.generator();
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

/// A planar wire with its start.
struct PlanarProblem {
  PlanarWire wire;
  double grading = 0.0;
  Places x, v;
  Plane plane;
  double duration = 0.0;
  double slowest = 0.0;  ///< about the angular frequency of its slowest mode
};

/// Wires of 0.05 to 1 m that begin bent, stretched and moving.
inline PlanarProblem random_planar_wire(Draws& draw) {
  using std::numbers::pi;
  PlanarProblem p;
  PlanarWire& w = p.wire;
  const double length = draw.of_any_size(0.05, 1.0), square = length * length;
  const int edges = draw.count(4, 10);
  p.grading = draw.chance(0.3) ? draw.between(0.3, 1.5) : 0.0;
  w.rest = graded_edges(length, edges, p.grading);
  w.mass_per_length = draw.of_any_size(1e-3, 0.1);
  w.bending = draw.of_any_size(1e-4, 0.1);
  w.axial = w.bending / square * draw.of_any_size(1e3, 1e4);
  w.has_curvatures = draw.chance(0.5);
  const std::vector<EndKind> kinds{EndKind::clamp, EndKind::clamp, EndKind::pin, EndKind::free};
  w.left.kind = draw.one_of(kinds);
  w.right.kind = draw.one_of(kinds);
  if (w.left.kind != EndKind::clamp) std::swap(w.left.kind, w.right.kind);  // a single clamp is the left end
  p.slowest = 5.0 / square * std::sqrt(w.bending / w.mass_per_length);
  // Which way a wire is bent by nature only a clamp says.
  if (draw.chance(0.3) && w.left.kind == EndKind::clamp) w.natural = draw.between(-1.0, 1.0) / length;
  if (draw.chance(0.5)) w.bending_time = draw.of_any_size(1e-3, 0.1) / p.slowest;
  if (draw.chance(0.5)) w.axial_time = draw.of_any_size(1e-4, 1e-2) / p.slowest;
  if (draw.chance(0.3)) w.mass_rate = draw.of_any_size(1e-2, 1.0) * p.slowest;
  if (draw.chance(0.5)) {
    const double size = 0.1 * length * p.slowest * p.slowest, x = draw.between(-size, size);
    w.gravity = {x, draw.between(-size, size)};
  }
  p.duration = draw.between(0.3, 1.0) * 2.0 * pi / p.slowest;
  // In the plane across z the rod computes in two components, in another one in three.
  if (draw.chance(0.5)) p.plane.axes = random_turn(draw);

  const double turned = draw.between(-pi, pi), arc = draw.between(-0.4, 0.4), wave = draw.between(-0.4, 0.4),
               second = draw.between(-0.4, 0.4), at_left = draw.between(-0.1, 0.1),
               at_right = draw.between(-0.1, 0.1);
  const auto angle = [&](double s) {
    return turned + arc * s + wave * std::sin(pi * s) + second * std::sin(2.0 * pi * s);
  };
  const double strain = draw.between(-10.0, 10.0) * w.bending / square / w.axial;
  const double fast = 0.1 * length * p.slowest;
  std::array<Vector2, 3> speeds;
  for (Vector2& v : speeds) {
    const double x = draw.between(-fast, fast);
    v = {x, draw.between(-fast, fast)};
  }
  // Waves of the velocities are zero at ends that are held.
  const double from = w.left.kind == EndKind::free ? 0.5 : 0.0,
               to = w.right.kind == EndKind::free ? 0.5 : 1.0;
  Vector2 place(0.1 * length, -0.05 * length);
  double s = 0.0;
  for (std::size_t i = 0; i < w.vertices(); ++i) {
    p.x.push_back(place);
    Vector2 v = Vector2::Zero();
    for (std::size_t k = 0; k < speeds.size(); ++k)
      v += std::sin(pi * (from + (to - from + static_cast<double>(k)) * s / length)) * speeds[k];
    p.v.push_back(w.holds(i) ? Vector2(0.0, 0.0) : v);
    if (i == w.edges()) break;
    const double h = w.rest[i], a = angle((s + 0.5 * h) / length);
    place += h * (1.0 + strain) * Vector2(std::cos(a), std::sin(a));
    s += h;
  }
  w.left.direction = angle(0.0) + at_left;
  w.right.direction = angle(1.0) + at_right;
  return p;
}

inline const char* name_of(EndKind kind) {
  return kind == EndKind::clamp ? "clamp" : kind == EndKind::pin ? "pin" : "free";
}

inline std::string described(const PlanarProblem& p) {
  const PlanarWire& w = p.wire;
  std::string text = fmt::format(
      "{} edges, grading {:.9g}, {}, length {:.9g} m, EI {:.9g}, EA {:.9g}, natural {:.9g}, {:.9g} kg/m, "
      "damping "
      "{:.9g} {:.9g} "
      "{:.9g}, gravity {:.9g} {:.9g}, {} at {:.9g} to {} at {:.9g}, {}, {:.9g} s, start",
      w.edges(), p.grading, w.has_curvatures ? "higher order" : "vertices", w.length(), w.bending, w.axial,
      w.natural, w.mass_per_length, w.bending_time, w.axial_time, w.mass_rate, w.gravity.x(), w.gravity.y(),
      name_of(w.left.kind), w.left.direction, name_of(w.right.kind), w.right.direction,
      p.plane.axes.isIdentity() ? "across z" : "in an oblique plane", p.duration);
  for (std::size_t i = 0; i < p.x.size(); ++i)
    text += fmt::format(" ({:.9g} {:.9g}; {:.9g} {:.9g})", p.x[i].x(), p.x[i].y(), p.v[i].x(), p.v[i].y());
  return text;
}

inline wire::SpatialEnd::Kind simulated_kind(EndKind kind) {
  return kind == EndKind::clamp ? wire::SpatialEnd::Kind::clamp
         : kind == EndKind::pin ? wire::SpatialEnd::Kind::pin
                                : wire::SpatialEnd::Kind::free;
}

/// The same wire for the simulation.
inline coupling::MotionWire simulated_wire(const PlanarProblem& p) {
  const PlanarWire& w = p.wire;
  wire::RodInMotion rod;
  rod.length = w.length();
  rod.elements = static_cast<int>(w.edges());
  rod.grading = p.grading;
  rod.mass_per_length = w.mass_per_length;
  rod.formulation = w.has_curvatures ? wire::Formulation::higher_order : wire::Formulation::vertices;
  rod.damping = {w.bending_time, w.axial_time, w.mass_rate};
  rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = w.bending;
  rod.properties.torsional_stiffness = 0.8 * w.bending;
  rod.properties.axial_stiffness = w.axial;
  rod.properties.natural_curvature = {w.natural, 0.0};  // towards the director, which stands to the left
  const auto end = [&](const PlanarEnd& e, const Vector2& at) {
    wire::SpatialEnd s;
    s.kind = simulated_kind(e.kind);
    s.position = p.plane.point(at);
    s.direction = p.plane.point({std::cos(e.direction), std::sin(e.direction)});
    s.director = p.plane.point({-std::sin(e.direction), std::cos(e.direction)});
    return s;
  };
  rod.properties.left = end(w.left, p.x.front());
  rod.properties.right = end(w.right, p.x.back());
  Eigen::Matrix3Xd x(3, w.vertices()), v(3, w.vertices());
  for (std::size_t i = 0; i < w.vertices(); ++i) {
    x.col(static_cast<Eigen::Index>(i)) = p.plane.point(p.x[i]);
    v.col(static_cast<Eigen::Index>(i)) = p.plane.point(p.v[i]);
  }
  return {"wire", rod, x, v, {}, {}};
}

/// Vectors one behind another; all of a state from an index on.
template <class Vector>
void append(State& state, const std::vector<Vector>& vectors) {
  for (const Vector& v : vectors) state.insert(state.end(), v.begin(), v.end());
}
template <class Vector>
void take(const State& state, std::size_t from, std::vector<Vector>& vectors) {
  for (Vector& v : vectors) {
    std::copy_n(state.begin() + static_cast<std::ptrdiff_t>(from), v.size(), v.begin());
    from += static_cast<std::size_t>(v.size());
  }
}

/// Of a sample the places and velocities of a planar wire's vertices.
inline void sample_wire(const PlanarProblem& p, const coupling::MotionSample& s, Places& x, Places& v) {
  x.clear();
  v.clear();
  for (Eigen::Index i = 0; i < s.wires[0].cols(); ++i) {
    x.push_back(p.plane.seen(s.wires[0].col(i)));
    v.push_back(p.plane.seen(s.wire_loads[0].velocities.col(i)));
  }
}

/// Runs the problems of one kind; each must end within its limit, and in half of them there is something to
/// compare.
template <class Problem>
void judge_all(int count, Problem (*draw_one)(Draws&), Verdict (*judge)(const Problem&)) {
  const Problems problems(count);
  std::string worst;
  double largest = -1.0;
  int counted = 0;
  for (int k = problems.first; k < problems.end; ++k) {
    Draws draw(problems.seed, k);
    const Problem p = draw_one(draw);
    Verdict v;
    try {
      v = judge(p);
    } catch (const NoBalance&) {
      v.counts = false;
    }
    if (!v.counts) continue;
    ++counted;
    const std::string text = fmt::format("problem {}: {}: {}", k, v.text, described(p));
    EXPECT_LE(v.of_limit, 1.0) << text;
    EXPECT_GE(v.last, 1u) << text;
    if (v.of_limit <= largest) continue;
    largest = v.of_limit;
    worst = text;
  }
  EXPECT_GE(2 * counted, problems.end - problems.first - 1);
  ::testing::Test::RecordProperty("worst share of the limit", std::to_string(largest));
  if (::testing::Test::HasFailure()) ADD_FAILURE() << "worst: " << worst;
}

}  // namespace snare::referee
