// The push on the declared wire: error beside time, and what a Newton iteration costs beside bare factorisations.
//
// The curve: 20 points outward at the material mid-point to +1.5 mm, with the buckled initial state, one core.

#include "coupling/push_setup.hpp"
#include "coupling/push_solver.hpp"
#include "numerics/cholmod.hpp"
#include "numerics/kinsol.hpp"
#include "numerics/klu.hpp"
#include "numerics/path.hpp"

#include <benchmark/benchmark.h>

#include <cmath>

namespace {

using namespace snare;

constexpr double mm = 1e-3;
/// Planar extensible elastica by multiple shooting (validation/elastica_push.hpp), travel 1.5 mm [N].
constexpr double reference_force = 232.98287479;

coupling::PushTest declared_wire() {
  coupling::PushTest test;
  test.wire.diameter = 1.5 * mm;
  test.wire.length = 180.0 * mm;
  test.wire.youngs_modulus = 193e9;
  test.wire.poisson_ratio = 0.29;
  test.wire.density = 7930.0;
  test.mount.span = 175.0 * mm;
  test.contact_position = 87.5 * mm;
  for (int i = 1; i <= 20; ++i) test.travel.push_back(1.5 * mm * i / 20);
  return test;
}

void extrapolated_curve(benchmark::State& state) {
  const coupling::PushTest test = declared_wire();
  coupling::PushOptions options;
  options.elements = static_cast<int>(state.range(0));
  coupling::ExtrapolatedCurve result;
  for (auto _ : state) result = coupling::solve_push_extrapolated(test, options);
  state.counters["relative_error"] = std::abs(result.curve.points.back().force / reference_force - 1.0);
  state.counters["newton_per_point"] = static_cast<double>(result.curve.newton_iterations) / 20.0;
}
BENCHMARK(extrapolated_curve)->Arg(64)->Arg(128)->Arg(192)->Arg(256)->Arg(512)->Unit(benchmark::kMillisecond);

void single_mesh_curve(benchmark::State& state) {
  const coupling::PushTest test = declared_wire();
  coupling::PushOptions options;
  options.elements = static_cast<int>(state.range(0));
  coupling::PushCurve result;
  for (auto _ : state) result = coupling::solve_push(test, options);
  state.counters["relative_error"] = std::abs(result.points.back().force / reference_force - 1.0);
  state.counters["newton_per_point"] = static_cast<double>(result.newton_iterations) / 20.0;
}
BENCHMARK(single_mesh_curve)->Arg(64)->Arg(128)->Arg(256)->Arg(512)->Unit(benchmark::kMillisecond);

/// The pressed wire at 1 mm, ready for Newton iterations.
struct Pressed {
  coupling::PushSetup setup;
  numerics::PathPoint point;
  numerics::PathWorkspace workspace;

  explicit Pressed(int edges) : setup(coupling::prepare_push(declared_wire(), edges, 0.0, 1)) {
    setup.system->guided[0].status = coupling::ContactStatus::slip;
    point = setup.start;
    for (int k = 1; k <= 10; ++k) {
      point.parameter = 0.1 * mm * k;
      (void)numerics::correct(*setup.system, point, workspace, 50);
    }
    setup.system->assemble(point, workspace.system, workspace.by_parameter);
  }
};

/// Assembly, factorisation and solution: one Newton iteration. Linear in the edges.
void newton_iteration(benchmark::State& state) {
  Pressed p(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    p.setup.system->assemble(p.point, p.workspace.system, p.workspace.by_parameter);
    benchmark::DoNotOptimize(p.workspace.solver.factorize(p.workspace.system));
    p.workspace.band_step = -p.workspace.system.band_residual;
    p.workspace.border_step = -p.workspace.system.border_residual;
    p.workspace.solver.solve(p.workspace.system, p.workspace.band_step, p.workspace.border_step);
  }
  state.counters["ns_per_edge"] = benchmark::Counter(static_cast<double>(state.range(0)) * static_cast<double>(state.iterations()),
                                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// The yardstick: KLU refactors and solves the same bordered matrix, already assembled.
void bare_klu(benchmark::State& state) {
  Pressed p(static_cast<int>(state.range(0)));
  const numerics::SparseMatrix matrix = numerics::to_sparse(p.workspace.system);
  numerics::Klu klu(matrix);
  (void)klu.factorize(matrix);
  Eigen::VectorXd x(matrix.order);
  for (auto _ : state) {
    benchmark::DoNotOptimize(klu.factorize(matrix));
    x.setOnes();
    klu.solve(x);
  }
}

/// CHOLMOD, simplicial, natural order, of the band matrix alone.
void bare_cholmod(benchmark::State& state) {
  Pressed p(static_cast<int>(state.range(0)));
  const numerics::SparseMatrix lower = numerics::to_sparse(p.workspace.system.matrix, numerics::Triangle::lower);
  numerics::Cholmod cholmod(lower, numerics::Cholmod::Ordering::natural);
  Eigen::VectorXd x(lower.order);
  for (auto _ : state) {
    benchmark::DoNotOptimize(cholmod.factorize(lower));
    x.setOnes();
    cholmod.solve(x);
  }
}

/// The own band factorisation of the same matrix.
void bare_band(benchmark::State& state) {
  Pressed p(static_cast<int>(state.range(0)));
  numerics::BandLdlt factor;
  Eigen::VectorXd x(p.workspace.system.matrix.order());
  for (auto _ : state) {
    benchmark::DoNotOptimize(factor.factorize(p.workspace.system.matrix));
    x.setOnes();
    factor.solve(x);
  }
}

/// From the state at 1 mm to that at 1.05 mm: own Newton with the border ...
void step_by_newton(benchmark::State& state) {
  Pressed p(static_cast<int>(state.range(0)));
  int iterations = 0;
  for (auto _ : state) {
    numerics::PathPoint next = p.point;
    next.parameter = 1.05 * mm;
    iterations = numerics::correct(*p.setup.system, next, p.workspace, 50).iterations;
  }
  state.counters["iterations"] = iterations;
}

/// ... and KINSOL with KLU on the same equations.
void step_by_kinsol(benchmark::State& state) {
  Pressed p(static_cast<int>(state.range(0)));
  const auto n = p.point.band.size();
  const auto m = p.point.border.size();
  numerics::NonlinearSystem system;
  system.pattern = numerics::to_sparse(p.workspace.system);
  const auto at = [&](const Eigen::VectorXd& u) { return numerics::PathPoint{u.head(n), u.tail(m), 1.05 * mm}; };
  system.residual = [&](const Eigen::VectorXd& u, Eigen::VectorXd& f) {
    p.setup.system->assemble(at(u), p.workspace.system, p.workspace.by_parameter);
    f.resize(n + m);
    f << p.workspace.system.band_residual, p.workspace.system.border_residual;
  };
  system.jacobian = [&](const Eigen::VectorXd& u, numerics::SparseMatrix& j) {
    p.setup.system->assemble(at(u), p.workspace.system, p.workspace.by_parameter);
    j.value = numerics::to_sparse(p.workspace.system).value;
  };
  int iterations = 0;
  Eigen::VectorXd start(n + m);
  start << p.point.band, p.point.border;
  numerics::KinsolOptions options;
  options.residual_tolerance = 1e-6;
  for (auto _ : state) {
    Eigen::VectorXd u = start;
    iterations = numerics::solve_kinsol(system, u, options).iterations;
  }
  state.counters["iterations"] = iterations;
}

BENCHMARK(newton_iteration)->RangeMultiplier(10)->Range(100, 100'000)->Arg(128)->Arg(256)->Unit(benchmark::kMicrosecond);
BENCHMARK(bare_klu)->Arg(128)->Arg(256)->Unit(benchmark::kMicrosecond);
BENCHMARK(bare_cholmod)->Arg(128)->Arg(256)->Unit(benchmark::kMicrosecond);
BENCHMARK(bare_band)->Arg(128)->Arg(256)->Unit(benchmark::kMicrosecond);
BENCHMARK(step_by_newton)->Arg(128)->Arg(256)->Unit(benchmark::kMicrosecond);
BENCHMARK(step_by_kinsol)->Arg(128)->Arg(256)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
