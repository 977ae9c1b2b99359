// A body of 8.9 kg at 0.1 m/s meets the declared wire: real-time factor with 60 elements, time a step against the number
// of elements, ten runs at once on one and two threads.

#include "coupling/motion.hpp"
#include "wire/loose_wire.hpp"
#include "wire/specification.hpp"

#include <benchmark/benchmark.h>
#include <omp.h>

#include <memory>

namespace snare::benchmarks {
namespace {

constexpr double mm = 1e-3;
constexpr double span = 175.0 * mm;

coupling::Motion impact(int elements) {
  wire::WireSpecification w;
  w.diameter = 1.5 * mm;
  w.length = 180.0 * mm;
  w.youngs_modulus = 193e9;
  w.poisson_ratio = 0.29;
  w.density = 7930.0;
  wire::RodInMotion rod;
  rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = w.bending_stiffness();
  rod.properties.torsional_stiffness = w.torsional_stiffness();
  rod.properties.axial_stiffness = w.axial_stiffness();
  rod.properties.right.position = {span, 0.0, 0.0};
  rod.mass_per_length = w.mass_per_length();
  rod.length = w.length;
  rod.elements = elements;
  // A damping ratio of 0.7 % at the first frequency of the straight wire (assumed; steel wires show 0.1 to 1 %).
  rod.damping.bending_time = rod.damping.axial_time = 1e-5;
  wire::PlanarRodProperties plane;
  plane.bending_stiffness = rod.properties.bending_stiffness;
  plane.axial_stiffness = rod.properties.axial_stiffness;
  plane.right.position = {span, 0.0};
  const wire::PlanarRod planar(wire::MaterialMesh(elements / 2, elements - elements / 2, 0.0), plane);
  const wire::LooseWire loose = wire::find_loose_wire(planar, {0.0, 0.5 * w.length, w.length}, 1);
  coupling::Motion motion;
  motion.wires.push_back({"wire", rod, Eigen::Matrix3Xd::Zero(3, elements + 1), {}});
  for (int i = 0; i <= elements; ++i) motion.wires[0].positions.col(i) << wire::vertex(loose.state, i), 0.0;
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
  contact.shape_position = {50.0 * mm, 100.0 * mm, 0.0};
  contact.wire_radius = 0.5 * w.diameter;
  contact.friction = {0.3, 0.1, 0.01, 1.0};
  motion.contacts.push_back(contact);
  return motion;
}

void report(benchmark::State& state, const coupling::MotionResult& result) {
  const numerics::IdaStatistics& s = result.statistics;
  if (!result.report.usable()) state.SkipWithError(result.report.message.c_str());
  state.counters["real_time_factor"] = result.report.time / result.wall_seconds;
  state.counters["jacobian_and_factor_share"] = (s.jacobian_seconds + s.factor_seconds) / result.wall_seconds;
  state.counters["steps"] = static_cast<double>(s.steps);
  state.counters["jacobians"] = static_cast<double>(s.jacobians);
  state.counters["seconds_a_step"] = result.wall_seconds / static_cast<double>(s.steps);
}

// One second with one impact.
void one_wire(benchmark::State& state) {
  const coupling::Motion motion = impact(static_cast<int>(state.range(0)));
  coupling::MotionOptions options;
  options.duration = 1.0;
  coupling::MotionResult result;
  for (auto _ : state) result = coupling::simulate(motion, options);
  report(state, result);
}
BENCHMARK(one_wire)->Arg(60)->Unit(benchmark::kMillisecond);

// Fixed work a step: 20 steps before the touch, of a wire that the start has set quivering.
void elements(benchmark::State& state) {
  const coupling::Motion motion = impact(static_cast<int>(state.range(0)));
  coupling::MotionOptions options;
  options.duration = 2e-4;
  options.max_step = 1e-5;
  coupling::MotionResult result;
  for (auto _ : state) result = coupling::simulate(motion, options);
  report(state, result);
  state.SetComplexityN(state.range(0));
}
BENCHMARK(elements)
    ->RangeMultiplier(4)
    ->Range(64, 4096)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

void ten_runs(benchmark::State& state) {
  const coupling::Motion motion = impact(60);
  coupling::MotionOptions options;
  options.duration = 0.03;
  for (auto _ : state) {
#pragma omp parallel for num_threads(state.range(0)) schedule(dynamic)
    for (int k = 0; k < 10; ++k) benchmark::DoNotOptimize(coupling::simulate(motion, options));
  }
}
BENCHMARK(ten_runs)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace snare::benchmarks

BENCHMARK_MAIN();
