// A body of 8.9 kg at 0.1 m/s meets the declared wire: the head-on case beside the static curve, at equal
// error; real-time factor with 60 elements, where the time goes, error against cost, time a step against the
// number of elements, ten runs at once on one and two threads.

#include "base/units.hpp"
#include "benchmarks/declared_push.hpp"
#include "coupling/contact/mesh_shape.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "coupling/statics/push_solver.hpp"
#include "validation/declared_wire.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

namespace snare::benchmarks {
namespace {

using base::mm;
constexpr double span = 175.0 * mm;

coupling::Motion impact(int elements, wire::Formulation formulation = wire::Formulation::vertices) {
  const wire::WireSpecification w = validation::declared_specification();
  wire::RodInMotion rod = wire::rod_in_motion(w, span, elements);
  rod.formulation = formulation;
  // A damping ratio of 0.7 % at the first frequency of the straight wire (assumed; steel wires show 0.1 to 1
  // %).
  rod.damping.bending_time = rod.damping.axial_time = 1e-5;
  coupling::Motion motion;
  motion.wires.push_back({"wire", rod, coupling::resting_wire(rod), {}});
  constexpr double radius = 6.0 * mm;
  coupling::MotionBody body;
  body.properties.mass = 8.9;
  body.properties.inertia = 0.16 * Eigen::Matrix3d::Identity();
  const double top = motion.wires[0].positions(1, elements / 2);
  body.start.position = {37.5 * mm, top - radius - 0.5 * w.diameter - 100.1 * mm, 0.0};
  body.start.velocity = {0.0, 0.1, 0.0};
  motion.bodies.push_back(body);
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::Ball>(radius);
  contact.X_BS.p = {50.0 * mm, 100.0 * mm, 0.0};
  contact.wire_radius = 0.5 * w.diameter;
  contact.friction = {0.3, 0.1, 0.01, 1.0};
  motion.contacts.push_back(contact);
  return motion;
}

/// A ball of triangles, from pole to pole in `around`/2 rings.
std::shared_ptr<const coupling::ContactShape> tessellated_ball(double radius, int around) {
  coupling::TriangleMesh m;
  const int rings = around / 2 - 1;
  m.points.emplace_back(0.0, 0.0, -radius);
  for (int k = 1; k <= rings; ++k) {
    const double tilt = std::numbers::pi * (k / (rings + 1.0) - 0.5);
    for (int j = 0; j < around; ++j) {
      const double a = 2.0 * std::numbers::pi * j / around;
      m.points.emplace_back(radius * std::cos(tilt) * std::cos(a), radius * std::cos(tilt) * std::sin(a),
                            radius * std::sin(tilt));
    }
  }
  m.points.emplace_back(0.0, 0.0, radius);
  const auto point = [around](int k, int j) { return 1 + (k - 1) * around + j % around; };
  for (int j = 0; j < around; ++j) {
    m.triangles.push_back({0, point(1, j + 1), point(1, j)});
    m.triangles.push_back({1 + rings * around, point(rings, j), point(rings, j + 1)});
    for (int k = 1; k < rings; ++k) {
      m.triangles.push_back({point(k, j), point(k, j + 1), point(k + 1, j)});
      m.triangles.push_back({point(k, j + 1), point(k + 1, j + 1), point(k + 1, j)});
    }
  }
  return std::make_shared<coupling::MeshShape>(m);
}

void report(benchmark::State& state, const coupling::MotionResult& result) {
  const numerics::IdaStatistics& s = result.statistics;
  if (!result.report.usable()) state.SkipWithError(result.report.message.c_str());
  state.counters["real_time_factor"] = result.report.time / result.wall_seconds;
  state.counters["jacobian_and_factor_share"] = (s.jacobian_seconds + s.factor_seconds) / result.wall_seconds;
  state.counters["residual_share"] = s.residual_seconds / result.wall_seconds;
  state.counters["solve_share"] = s.solve_seconds / result.wall_seconds;
  state.counters["integrand_share"] = s.integrand_seconds / result.wall_seconds;
  state.counters["energy_error"] = result.energy.integrator / (0.5 * 8.9 * 0.01);  // over that of the impact
  state.counters["momentum_error"] = result.momentum_error.norm() / (8.9 * 0.1);
  state.counters["steps"] = static_cast<double>(s.steps);
  state.counters["jacobians"] = static_cast<double>(s.jacobians);
  state.counters["seconds_a_step"] = result.wall_seconds / static_cast<double>(s.steps);
}

constexpr double mass = 8.9;   // [kg]
constexpr double speed = 0.1;  // [m/s]
constexpr double probe = 6.0 * mm;

/// Case H: the declared wire, at rest in its buckled shape, is met head-on in its middle by a free body with
/// a cylinder as its probe, without friction.
coupling::Motion case_h_motion(const wire::RodInMotion& rod) {
  coupling::Motion motion;
  motion.wires.push_back({"wire", rod, coupling::resting_wire(rod), {}});
  const double touch = motion.wires[0].positions.row(1).maxCoeff() - probe -
                       0.5 * validation::declared_specification().diameter;
  coupling::MotionBody body;
  body.properties.mass = mass;
  body.properties.inertia = 0.16 * Eigen::Matrix3d::Identity();
  body.start.position = {0.5 * span, touch - 0.1 * mm, 0.0};
  body.start.velocity = {0.0, speed, 0.0};
  motion.bodies.push_back(body);
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::EndlessCylinder>(probe);
  contact.wire_radius = 0.5 * validation::declared_specification().diameter;
  motion.contacts.push_back(contact);
  return motion;
}

/// Peak force [N] on a body so slow that the wire is in equilibrium but for its damping all the time: m x'' =
/// -(F + tau x' G) with the static curve F(x) and the rate form G(x) of its shapes, theory.md (W.14), by the
/// midpoint rule.
double quasi_static_peak(double tau) {
  constexpr int points = 400;
  constexpr double spacing = 1.2 * mm / points;
  coupling::PushProblem test = validation::declared_wire(0.5 * span, probe);
  for (int i = 0; i <= points; ++i) test.travel.push_back(spacing * i);
  coupling::PushOptions with_rates;
  with_rates.examine_rates = true;
  const coupling::PushCurve curve = coupling::solve_push_extrapolated(test, {}).curve;
  const coupling::PushCurve rates = coupling::solve_push(test, with_rates);
  for (const coupling::PushCurve* c : {&curve, &rates})
    if (c->points.size() != test.travel.size()) throw std::runtime_error(c->report.message);
  const auto force = [&](double x, double v) {
    const double at = std::clamp(x / spacing, 0.0, points - 1e-6);
    const auto i = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(i);
    const auto between = [share](double a, double b) { return a + share * (b - a); };
    return between(curve.points[i].force, curve.points[i + 1].force) +
           tau * v * between(rates.points[i].viscous_stiffness, rates.points[i + 1].viscous_stiffness);
  };
  constexpr double step = 1e-6;  // [s]
  double peak = 0.0;
  for (double x = 0.0, v = speed; v > 0.0;) {
    peak = std::max(peak, force(x, v));
    const double middle = v - 0.5 * step * force(x, v) / mass;
    v -= step * force(x + 0.5 * step * v, middle) / mass;
    x += step * middle;
    if (x > points * spacing) throw std::runtime_error("the body is not stopped");
  }
  return peak;
}

/// The second argument of a benchmark.
wire::Formulation formulation_of(const benchmark::State& state) {
  return state.range(1) == 1 ? wire::Formulation::higher_order : wire::Formulation::vertices;
}

// In turn: the static curve of 20 points from the straight wire, and the head-on case from the buckled one to
// 0.3 s, of either formulation and without inertia. The impulse is that of two codes that agree to 6e-5.
void case_h(benchmark::State& state) {
  constexpr double impulse = 1.7784;  // [N s]
  constexpr double tau = 1e-5;        // of the wire's damping [s]
  static const double peak = quasi_static_peak(tau);
  static const double undamped = quasi_static_peak(0.0);
  wire::RodInMotion rod =
      wire::rod_in_motion(validation::declared_specification(), span, static_cast<int>(state.range(0)));
  rod.formulation = formulation_of(state);
  rod.quasi_static = state.range(2) == 1;
  rod.damping.bending_time = rod.damping.axial_time = tau;
  coupling::MotionOptions options;
  options.duration = 0.3;
  const coupling::PushProblem test = declared_push();
  coupling::MotionResult result;
  std::vector<double> seconds;
  for ([[maybe_unused]] auto _ : state) {
    seconds = median_times({[&] { benchmark::DoNotOptimize(coupling::solve_push(test, {}).points.data()); },
                            [&] { result = coupling::simulate(case_h_motion(rod), options); }},
                           5, 1);
  }
  report(state, result);
  state.counters["static_seconds"] = seconds[0];
  state.counters["motion_seconds"] = seconds[1];
  state.counters["over_static_curve"] = seconds[1] / seconds[0];
  state.counters["quasi_static_peak_N"] = peak;
  state.counters["undamped_quasi_static_peak_N"] = undamped;
  state.counters["peak_force_error"] = result.peak_force[0] / peak - 1.0;
  state.counters["impulse_error"] = result.impulse[0].norm() / impulse - 1.0;
}
BENCHMARK(case_h)
    ->ArgNames({"elements", "higher_order", "quasi_static"})
    ->Args({12, 1, 0})  // a rod that costs next to nothing
    ->Args({12, 1, 1})
    ->ArgsProduct({{30, 40, 60, 120, 240}, {0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

// One second with one impact.
void one_wire(benchmark::State& state) {
  const coupling::Motion motion = impact(static_cast<int>(state.range(0)), formulation_of(state));
  coupling::MotionOptions options;
  options.duration = 1.0;
  coupling::MotionResult result;
  for ([[maybe_unused]] auto _ : state) result = coupling::simulate(motion, options);
  report(state, result);
}
BENCHMARK(one_wire)
    ->ArgNames({"elements", "higher_order"})
    ->Args({60, 0})
    ->Args({40, 1})
    ->Args({60, 1})
    ->Unit(benchmark::kMillisecond);

/// Three wires that are closed on a shaft: chords at 120 degrees from each other, 3 mm apart along it, each
/// bulging past the shaft's middle to 0.1 mm from its surface; a body of 8.9 kg with friction swings between
/// them.
coupling::Motion held_shaft(int elements, bool quasi_static) {
  const wire::WireSpecification w = validation::declared_specification();
  coupling::Motion motion;
  coupling::MotionBody body;
  body.properties.mass = mass;
  body.properties.inertia = 0.16 * Eigen::Matrix3d::Identity();
  body.start.velocity = {0.05, 0.03, 0.0};
  motion.bodies.push_back(body);
  for (int k = 0; k < 3; ++k) {
    wire::RodInMotion rod = wire::rod_in_motion(w, span, elements);
    rod.quasi_static = quasi_static;
    rod.damping.bending_time = rod.damping.axial_time = 1e-5;
    coupling::MotionWire held{"wire" + std::to_string(k), rod, coupling::resting_wire(rod), {}};
    const double bulge = held.positions.row(1).maxCoeff();
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(2.0 * std::numbers::pi / 3.0 * k, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d shift(-0.5 * span, probe + 0.5 * w.diameter + 0.1 * mm - bulge, 3.0 * mm * (k - 1));
    held.positions = turn * (held.positions.colwise() + shift);
    for (const wire::End which : wire::ends) {
      wire::SpatialEnd& end = which == wire::End::left ? held.rod.properties.left : held.rod.properties.right;
      end.position = turn * (end.position + shift);
      end.direction = turn * end.direction;
      end.director = turn * end.director;
    }
    motion.wires.push_back(held);
    coupling::MotionContact contact;
    contact.name = "shaft on wire" + std::to_string(k);
    contact.shape = std::make_shared<coupling::EndlessCylinder>(probe);
    contact.wire = k;
    contact.wire_radius = 0.5 * w.diameter;
    contact.friction = {0.3, 0.1, 0.01, 1.0};
    motion.contacts.push_back(contact);
  }
  return motion;
}

// One second, most of it in contact with one wire or two.
void three_wires(benchmark::State& state) {
  const coupling::Motion motion = held_shaft(static_cast<int>(state.range(0)), state.range(1) == 1);
  coupling::MotionOptions options;
  options.duration = 1.0;
  coupling::MotionResult result;
  for ([[maybe_unused]] auto _ : state) result = coupling::simulate(motion, options);
  report(state, result);
}
BENCHMARK(three_wires)
    ->ArgNames({"elements", "quasi_static"})
    ->Args({60, 0})
    ->Args({60, 1})
    ->Unit(benchmark::kMillisecond);

// The impact with the tolerances times 10^k, k = -2 ... 2: error of the impulse against that at 10^-3.
void tolerances(benchmark::State& state) {
  const coupling::Motion motion = impact(60);
  const auto run = [&motion](double factor) {
    coupling::MotionOptions o;
    o.duration = 0.1;
    for (double* t :
         {&o.relative_tolerance, &o.position_tolerance, &o.velocity_tolerance, &o.twist_tolerance,
          &o.body_position_tolerance, &o.body_velocity_tolerance, &o.angle_tolerance, &o.spin_tolerance}) {
      *t *= factor;
    }
    return coupling::simulate(motion, o);
  };
  static const coupling::MotionResult reference = run(1e-3);
  coupling::MotionResult result;
  for ([[maybe_unused]] auto _ : state) result = run(std::pow(10.0, static_cast<double>(state.range(0))));
  report(state, result);
  state.counters["impulse_error"] =
      (result.impulse[0] - reference.impulse[0]).norm() / reference.impulse[0].norm();
  state.counters["peak_force_error"] = std::abs(result.peak_force[0] / reference.peak_force[0] - 1.0);
}
BENCHMARK(tolerances)->DenseRange(-2, 2)->Unit(benchmark::kMillisecond);

// Fixed work a step: 20 steps before the touch, of a wire that the start has set quivering.
void elements(benchmark::State& state) {
  const coupling::Motion motion = impact(static_cast<int>(state.range(0)));
  coupling::MotionOptions options;
  options.duration = 2e-4;
  options.max_step = 1e-5;
  coupling::MotionResult result;
  for ([[maybe_unused]] auto _ : state) result = coupling::simulate(motion, options);
  report(state, result);
  state.SetComplexityN(state.range(0));
}
BENCHMARK(elements)
    ->RangeMultiplier(4)
    ->Range(64, 4096)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

// What finding touches costs a step beside the whole step, far from the wire and in contact: share of the
// run. The pin is a ball or its tessellation in 2400 triangles.
void search(benchmark::State& state) {
  const int elements_of_wire = static_cast<int>(state.range(0));
  const bool mesh = state.range(1) != 0;
  const bool near = state.range(2) != 0;
  coupling::Motion motion = impact(elements_of_wire);
  if (mesh) motion.contacts[0].shape = tessellated_ball(6.0 * mm, 50);
  if (!near) motion.bodies[0].start.position.y() -= 50.0 * mm;
  coupling::MotionOptions options;
  options.duration = near ? 2e-3 : 2e-4;
  options.max_step = 1e-5;
  coupling::MotionResult result;
  for ([[maybe_unused]] auto _ : state) result = coupling::simulate(motion, options);
  report(state, result);
}
BENCHMARK(search)
    ->ArgNames({"elements", "mesh", "near"})
    ->ArgsProduct({{1000}, {0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

// For comparison: the distance of all 1001 vertices, which a search without bounds asks for at least once a
// step.
void scan_all_vertices(benchmark::State& state) {
  const bool mesh = state.range(0) != 0;
  const coupling::Motion motion = impact(1000);
  const auto shape = mesh ? tessellated_ball(6.0 * mm, 50) : motion.contacts[0].shape;
  const Eigen::Vector3d place = motion.bodies[0].start.position + motion.contacts[0].X_BS.p;
  for ([[maybe_unused]] auto _ : state) {
    double least = 1.0;
    for (const auto& x : motion.wires[0].positions.colwise())
      least = std::min(least, shape->distance(x - place));
    benchmark::DoNotOptimize(least);
  }
}
BENCHMARK(scan_all_vertices)->ArgName("mesh")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// Ten independent runs on one thread and on two in turn, 25 times: the median time of the first over that of
// the second.
void ten_runs(benchmark::State& state) {
  const coupling::Motion motion = impact(60);
  coupling::MotionOptions options;
  options.duration = 0.03;
  const auto runs = [&](int threads) {
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int k = 0; k < 10; ++k) benchmark::DoNotOptimize(coupling::simulate(motion, options));
  };
  std::vector<double> medians;
  for ([[maybe_unused]] auto _ : state) medians = median_times({[&] { runs(1); }, [&] { runs(2); }}, 25, 1);
  state.counters["speed_up_on_two_threads"] = medians[0] / medians[1];
}
BENCHMARK(ten_runs)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace snare::benchmarks

BENCHMARK_MAIN();
