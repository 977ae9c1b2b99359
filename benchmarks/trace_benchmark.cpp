// A whole trace: six series of 39 readings, load and unload, every effect of the catalogue, and where its
// time goes.

#include "identification/effects/catalogue.hpp"
#include "identification/tracing/trace.hpp"
#include "validation/blind_set.hpp"

#include <benchmark/benchmark.h>

#include <ctime>
#include <map>

namespace {

using namespace snare;

void whole_trace(benchmark::State& state, const char* effect) {
  const validation::BlindSet set = validation::make_blind_set(effect, 30.0, 1);
  std::map<std::string, double> seconds;
  for ([[maybe_unused]] auto _ : state) {
    const identification::Trace t = identification::trace(set.experiment);
    benchmark::DoNotOptimize(t.final.rmse);
    for (const auto& [what, time] : t.seconds) seconds[what] += time;
  }
  for (const auto& [what, time] : seconds)
    state.counters[what] = time / static_cast<double>(state.iterations());
}

/// `processor` is the CPU time of all threads [s].
void time_traces(benchmark::State& state, const identification::Experiment& experiment) {
  double processor = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    const std::clock_t before = std::clock();
    const identification::Trace t = identification::trace(experiment);
    benchmark::DoNotOptimize(t.final.rmse);
    processor += static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    state.SetLabel(to_string(t.kind));
  }
  state.counters["processor"] = processor / static_cast<double>(state.iterations());
}

/// Six series of 499 readings, with intervals.
void long_records(benchmark::State& state, const char* effect, double size) {
  const validation::BlindSet set = validation::make_blind_set(effect, size, 1, {.readings_a_leg = 250});
  time_traces(state, set.experiment);
}

/// Six replicates of 500 readings, loading, of which nothing or the strands are missing.
void replicates(benchmark::State& state, const char* effect, double size) {
  validation::BlindSet set =
      validation::make_blind_set(effect, size, 1, {.readings_a_leg = 500, .replicates = 6});
  set.experiment.series.resize(6);
  for (identification::Series& s : set.experiment.series) {
    identification::Readings& r = *s.readings;
    r.displacement.resize(500);
    r.force.resize(500);
    r.time.resize(500);
    s.test.travel = r.displacement;
  }
  time_traces(state, set.experiment);
}

void force_and_derivatives(benchmark::State& state) {
  const validation::BlindSet set = validation::make_blind_set("none", 0.0, 1);
  identification::SolverSettings solver;
  solver.elements = 128;
  const identification::Model model(set.experiment.series, solver);
  std::vector<const identification::Parameter*> by;
  for (const char* key : {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N", "wire.length_mm"}) {
    by.push_back(&identification::parameters().at(key));
  }
  by.resize(static_cast<std::size_t>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(model.evaluate({}, by).force.front()[0]);
}

BENCHMARK_CAPTURE(whole_trace, wire_length, "wire_length")
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);
BENCHMARK_CAPTURE(whole_trace, strand_hysteresis, "strand_hysteresis")
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);
BENCHMARK_CAPTURE(whole_trace, drift, "drift")->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);
BENCHMARK_CAPTURE(long_records, nothing, "none", 30.0)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);
BENCHMARK_CAPTURE(long_records, span, "span", 30.0)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);
BENCHMARK_CAPTURE(long_records, strand_hysteresis, "strand_hysteresis", 30.0)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);
BENCHMARK_CAPTURE(long_records, mount_slip, "mount_slip", 30.0)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);
BENCHMARK_CAPTURE(long_records, damage, "damage", 100.0)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);
BENCHMARK_CAPTURE(replicates, nothing, "none", 30.0)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);
BENCHMARK_CAPTURE(replicates, strand_hysteresis, "strand_hysteresis", 300.0)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);
BENCHMARK(force_and_derivatives)->Arg(0)->Arg(1)->Arg(3)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
