// What a distilled law costs beside the solve that it replaces, and what the default table costs.

#include "coupling/statics/push_solver.hpp"
#include "reduction/distil.hpp"

#include <law.hpp>  // generated: see CMakeLists.txt

#include <benchmark/benchmark.h>
#include <omp.h>

#include <functional>
#include <vector>

namespace {

using namespace snare;

/// The wire traced from the published tests.
const reduction::WireFile& wire_file() {
  static const reduction::WireFile file =
      reduction::read_wire_file(SNARE_BENCHMARK_DATA "/wires/traced_published.toml");
  return file;
}

const reduction::DistilledCase& distilled() {
  static const reduction::Distillation result = reduction::distil(wire_file());
  return result.cases.front();
}

/// Travels in no order, so that no cell is met twice in a row by design.
std::vector<double> travels() {
  std::vector<double> d;
  for (int i = 0; i < 4096; ++i) d.push_back(4e-3 * ((i * 1597) % 4096) / 4096.0);
  return d;
}

void TableForce(benchmark::State& state) {
  const coupling::ForceTable& table = *distilled().table.loading;
  const std::vector<double> d = travels();
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(
        table.force(d[i % 4096], 0.035 + 10.0 * d[(i + 7) % 4096], 4e-4 + 0.05 * d[(i + 13) % 4096]));
    ++i;
  }
}
BENCHMARK(TableForce);

void LawForce(benchmark::State& state) {
  const reduction::FittedLaw& law = distilled().places[1].laws.at(static_cast<std::size_t>(state.range(0)));
  state.SetLabel(law.form->name());
  const std::vector<double> d = travels();
  std::size_t i = 0;
  const coupling::SpringLawPointer spring = law.form->with(law.values);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(spring->force(d[i++ % 4096]));
}
BENCHMARK(LawForce)->DenseRange(0, 6);

/// The same quadratic as other programs get it: the exported header, compiled into this program.
void ExportedLawForce(benchmark::State& state) {
  const std::vector<double> d = travels();
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(snare_law::quadratic_s65(d[i++ % 4096]));
}
BENCHMARK(ExportedLawForce);

void ExportedTableForce(benchmark::State& state) {
  const std::vector<double> d = travels();
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(
        snare_law::force(d[i % 4096], 0.035 + 10.0 * d[(i + 7) % 4096], 4e-4 + 0.05 * d[(i + 13) % 4096]));
    ++i;
  }
}
BENCHMARK(ExportedTableForce);

/// The solve that an evaluation replaces: one travel from the straight wire, extrapolated from three meshes.
void FullWireForce(benchmark::State& state) {
  coupling::PushProblem test = wire_file().cases.front().test;
  test.contact_position = 0.065;
  test.travel = {3e-3};
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(coupling::solve_push_extrapolated(test, {}).curve.points.back().force);
}
BENCHMARK(FullWireForce)->Unit(benchmark::kMicrosecond);

/// The default table, 20 x 9 x 5, from scratch: knots placed, nodes solved, bound checked.
reduction::BuiltTable default_table() {
  const reduction::WireFile& file = wire_file();
  reduction::CurveStore store(file.cases.front(), file.settings,
                              reduction::sampling_travel(file.cases.front(), file.settings));
  return reduction::build_table(store, file.settings);
}

void DefaultTable(benchmark::State& state) {
  omp_set_num_threads(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    const reduction::BuiltTable built = default_table();
    state.counters["bound_share"] = built.loading_error.bound / built.loading_error.force_range;
    state.counters["curves"] = static_cast<double>(built.curves);
  }
  omp_set_num_threads(omp_get_num_procs());
}

/// Two tables at once, each on one thread: what two cores of this machine can do for work that shares
/// nothing.
void TwoDefaultTables(benchmark::State& state) {
  omp_set_max_active_levels(1);
  for ([[maybe_unused]] auto _ : state) {
#pragma omp parallel for num_threads(2) schedule(static, 1)
    for (int k = 0; k < 2; ++k) benchmark::DoNotOptimize(default_table().curves);
  }
}

/// The part of it that does not run in parallel: the same with every curve known.
void DefaultTableKnownCurves(benchmark::State& state) {
  const reduction::WireFile& file = wire_file();
  reduction::CurveStore store(file.cases.front(), file.settings,
                              reduction::sampling_travel(file.cases.front(), file.settings));
  static_cast<void>(reduction::build_table(store, file.settings));
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(reduction::build_table(store, file.settings).loading_error.bound);
}
BENCHMARK(DefaultTableKnownCurves)->Unit(benchmark::kMillisecond);

BENCHMARK(DefaultTable)->Arg(1)->Arg(2)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(TwoDefaultTables)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
