// A whole trace: six series of 39 readings, load and unload, every effect of the catalogue, and where its time goes.

#include "identification/effects/catalogue.hpp"
#include "identification/tracing/trace.hpp"
#include "validation/blind_set.hpp"

#include <benchmark/benchmark.h>

#include <map>

namespace {

using namespace snare;

void whole_trace(benchmark::State& state, const char* effect) {
  const validation::BlindSet set = validation::make_blind_set(effect, 30.0, 1);
  std::map<std::string, double> seconds;
  for (auto _ : state) {
    const identification::Trace t = identification::trace(set.experiment);
    benchmark::DoNotOptimize(t.final.rmse);
    for (const auto& [what, time] : t.seconds) seconds[what] += time;
  }
  for (const auto& [what, time] : seconds) state.counters[what] = time / static_cast<double>(state.iterations());
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
  for (auto _ : state) benchmark::DoNotOptimize(model.evaluate({}, by).force.front()[0]);
}

BENCHMARK_CAPTURE(whole_trace, wire_length, "wire_length")->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);
BENCHMARK_CAPTURE(whole_trace, strand_hysteresis, "strand_hysteresis")
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);
BENCHMARK_CAPTURE(whole_trace, drift, "drift")->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);
BENCHMARK(force_and_derivatives)->Arg(0)->Arg(1)->Arg(3)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
