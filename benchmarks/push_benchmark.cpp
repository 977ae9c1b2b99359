// The 20-point outward curve, error beside time; one equilibrium by our Newton's method and by KINSOL; the
// cost of a Newton iteration against the number of elements.

#include "base/units.hpp"
#include "benchmarks/declared_push.hpp"
#include "benchmarks/peers/bordered_pattern.hpp"
#include "benchmarks/peers/kinsol.hpp"
#include "coupling/statics/push_solver.hpp"
#include "wire/statics/equilibrium.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace snare::benchmarks {
namespace {

using base::mm;

// Median over all points but the first, whose iterations include those of the buckled initial state.
double iterations_per_point(const coupling::PushCurve& curve) {
  std::vector<int> iterations;
  for (std::size_t i = 1; i < curve.points.size(); ++i) iterations.push_back(curve.points[i].iterations);
  if (iterations.empty()) return 0.0;
  std::nth_element(iterations.begin(),
                   iterations.begin() + static_cast<std::ptrdiff_t>(iterations.size() / 2), iterations.end());
  return iterations[iterations.size() / 2];
}

void report(benchmark::State& state, const coupling::PushCurve& curve, int meshes) {
  if (!curve.report.usable() || curve.points.size() != declared_push().travel.size()) {
    state.SkipWithError("the curve was not reached");
    return;
  }
  const double error = std::abs(curve.points.back().force / reference_force - 1.0);
  const double iterations = curve.newton_iterations;
  state.counters["force_error"] = error;
  state.counters["newton_iterations"] = iterations;
  state.counters["newton_iterations_per_point_and_mesh"] = iterations_per_point(curve) / meshes;
  state.counters["seconds_per_newton_iteration"] = benchmark::Counter(
      iterations, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// The whole curve from the straight wire: buckling, first touch, 20 points; three nested meshes,
/// extrapolated.
void OutwardCurveExtrapolated(benchmark::State& state) {
  const coupling::PushProblem test = declared_push();
  coupling::PushOptions options;
  options.elements = static_cast<int>(state.range(0));
  coupling::ExtrapolatedCurve result;
  for ([[maybe_unused]] auto _ : state) {
    result = coupling::solve_push_extrapolated(test, options);
    benchmark::DoNotOptimize(result.curve.points.data());
  }
  report(state, result.curve, 3);
}

/// The same on one mesh.
void OutwardCurve(benchmark::State& state) {
  const coupling::PushProblem test = declared_push();
  coupling::PushOptions options;
  options.elements = static_cast<int>(state.range(0));
  coupling::PushCurve curve;
  for ([[maybe_unused]] auto _ : state) {
    curve = coupling::solve_push(test, options);
    benchmark::DoNotOptimize(curve.points.data());
  }
  report(state, curve, 1);
}

/// One step of 0.075 mm from 0.75 mm, no predictor, by our Newton's method.
void EquilibriumOwnNewton(benchmark::State& state) {
  PressedWire wire = pressed_wire(static_cast<int>(state.range(0)), 0.75 * mm);
  wire.point.parameter = 0.825 * mm;
  numerics::PathWorkspace workspace;
  numerics::SolveReport report;
  numerics::PathPoint point;
  for ([[maybe_unused]] auto _ : state) {
    point = wire.point;
    report = numerics::correct(*wire.system, point, workspace, 20);
    benchmark::DoNotOptimize(point.band.data());
  }
  if (!report.usable()) state.SkipWithError("not converged");
  state.counters["newton_iterations"] = report.iterations;
  state.counters["force_N"] = wire.system->pusher_force(point).y();
}

/// The same step by KINSOL with KLU: analytic Jacobian refilled through its slots, tolerances as in ours;
/// with the set-up of the solver and the analysis of the pattern in every solution, as `solve_kinsol` does.
void EquilibriumKinsol(benchmark::State& state) {
  PressedWire wire = pressed_wire(static_cast<int>(state.range(0)), 0.75 * mm);
  wire.point.parameter = 0.825 * mm;
  coupling::PushSystem& system = *wire.system;
  const auto n = wire.point.band.size();
  const auto m = wire.point.border.size();

  // Residuals in units of what our error() allows, so that both stop at the same accuracy.
  const wire::PlanarRodProperties& p = wire.rod->properties();
  double shortest = 1.0;
  const wire::Controls controls = system.state(wire.point).controls;
  for (int e = 0; e < wire.rod->mesh().edges(); ++e) {
    shortest = std::min(shortest, wire.rod->mesh().rest_length(e, controls));
  }
  const double length = controls[2] - controls[0];
  const double force = wire::force_tolerance(1e-10, p.bending_stiffness, p.axial_stiffness, length, shortest,
                                             wire.point.border.head<2>().norm());
  Eigen::VectorXd scale = Eigen::VectorXd::Constant(n + m, 1.0 / force);
  for (const int row : {0, 1, 3})
    scale[n + row] = 1.0 / (1e-12 * length);  // positions; row 2: sliding, a force

  numerics::BorderedSystem bordered;
  Eigen::VectorXd by_parameter;
  const auto assemble = [&](const Eigen::VectorXd& u) {
    system.assemble({u.head(n), u.tail(m), wire.point.parameter}, bordered, by_parameter);
  };
  Eigen::VectorXd start(n + m);
  start << wire.point.band, wire.point.border;
  assemble(start);
  const BorderedPattern pattern(bordered, BorderedPattern::Zeros::kept);
  NonlinearSystem nonlinear;
  nonlinear.pattern = pattern.pattern();
  nonlinear.residual = [&](const Eigen::VectorXd& u, Eigen::VectorXd& residual) {
    assemble(u);
    residual.resize(n + m);
    residual << bordered.band_residual, bordered.border_residual;
    residual.array() *= scale.array();
  };
  nonlinear.jacobian = [&](const Eigen::VectorXd& u, numerics::SparseMatrix& jacobian) {
    assemble(u);
    if (!pattern.refill(bordered, jacobian)) throw std::runtime_error("the pattern has changed");
    for (std::size_t k = 0; k < jacobian.value.size(); ++k) jacobian.value[k] *= scale[jacobian.row[k]];
  };
  KinsolOptions options;
  options.residual_tolerance = 1.0;

  numerics::SolveReport report;
  Eigen::VectorXd u;
  for ([[maybe_unused]] auto _ : state) {
    u = start;
    report = solve_kinsol(nonlinear, u, options);
    benchmark::DoNotOptimize(u.data());
  }
  if (!report.usable()) state.SkipWithError(report.message.c_str());
  state.counters["newton_iterations"] = report.iterations;
  state.counters["force_N"] = u[n + 1];
}

/// Assembly, check, factorisation and solution at a fixed state.
void NewtonIteration(benchmark::State& state) {
  const auto elements = static_cast<int>(state.range(0));
  PressedWire wire = buckled_shape(elements);
  numerics::PathWorkspace workspace;
  for ([[maybe_unused]] auto _ : state) {
    newton_iteration(*wire.system, wire.point, workspace);
    benchmark::DoNotOptimize(workspace.band_step.data());
  }
  state.counters["seconds_per_element"] = benchmark::Counter(
      elements, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["pivot_ratio"] = workspace.solver.pivot_ratio();
  state.counters["blockwise"] = workspace.solver.blockwise() ? 1 : 0;
  state.SetComplexityN(elements);
}

BENCHMARK(OutwardCurveExtrapolated)->RangeMultiplier(2)->Range(64, 512)->Unit(benchmark::kMillisecond);
BENCHMARK(OutwardCurve)->RangeMultiplier(2)->Range(64, 512)->Unit(benchmark::kMillisecond);
BENCHMARK(EquilibriumOwnNewton)->Arg(256)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK(EquilibriumKinsol)->Arg(256)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK(NewtonIteration)
    ->Arg(100)
    ->Arg(300)
    ->Arg(1000)
    ->Arg(3000)
    ->Arg(10000)
    ->Arg(30000)
    ->Arg(100000)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity(benchmark::oN);

}  // namespace
}  // namespace snare::benchmarks

BENCHMARK_MAIN();
