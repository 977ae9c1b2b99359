// One linear system of the push by every solver at hand. The yardstick is a bare klu_refactor + klu_solve of
// the whole bordered matrix, in its smallest pattern.

#include "base/units.hpp"
#include "benchmarks/declared_push.hpp"
#include "benchmarks/peers/bordered_pattern.hpp"
#include "benchmarks/peers/cholmod.hpp"
#include "numerics/klu.hpp"

#include <benchmark/benchmark.h>
#include <klu.h>

#include <Eigen/Core>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace snare::benchmarks {
namespace {

using base::mm;
constexpr double travel = 0.75 * mm;

using numerics::SparseMatrix;

/// KLU without our handles: analysed and factorised once; `run` refactorises and solves, nothing else.
class BareKlu {
 public:
  explicit BareKlu(SparseMatrix matrix) : matrix_(std::move(matrix)), right_(matrix_.order) {
    klu_defaults(&common_);
    symbolic_ = klu_analyze(matrix_.order, matrix_.column_start.data(), matrix_.row.data(), &common_);
    if (symbolic_ == nullptr) throw std::runtime_error("klu_analyze failed");
    numeric_ = klu_factor(matrix_.column_start.data(), matrix_.row.data(), matrix_.value.data(), symbolic_,
                          &common_);
    if (numeric_ == nullptr) {
      klu_free_symbolic(&symbolic_, &common_);
      throw std::runtime_error("klu_factor failed");
    }
  }
  ~BareKlu() {
    klu_free_numeric(&numeric_, &common_);
    klu_free_symbolic(&symbolic_, &common_);
  }
  BareKlu(const BareKlu&) = delete;
  BareKlu& operator=(const BareKlu&) = delete;

  void run(const Eigen::VectorXd& b) {
    klu_refactor(matrix_.column_start.data(), matrix_.row.data(), matrix_.value.data(), symbolic_, numeric_,
                 &common_);
    right_ = b;
    klu_solve(symbolic_, numeric_, matrix_.order, 1, right_.data(), &common_);
    benchmark::DoNotOptimize(right_.data());
  }
  [[nodiscard]] int entries() const { return numeric_->lnz + numeric_->unz; }

 private:
  SparseMatrix matrix_;
  Eigen::VectorXd right_;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

/// One system of the push, in every form.
struct LinearSystem {
  PressedWire wire;
  numerics::PathWorkspace workspace;
  SparseMatrix whole;
  numerics::SymmetricBandMatrix held;  ///< K held at its contact, as the bordered solver factorises it
  Eigen::VectorXd right;               ///< of the whole
  Eigen::VectorXd right_band;          ///< of K

  explicit LinearSystem(int elements) : wire(pressed_wire(elements, travel)) {
    newton_iteration(*wire.system, wire.point, workspace);
    const numerics::BorderedSystem& system = workspace.system;
    const BorderedPattern pattern(system, BorderedPattern::Zeros::dropped);
    whole = pattern.pattern();
    if (!pattern.refill(system, whole)) throw std::runtime_error("the pattern does not fit its own system");
    held = system.matrix;
    for (const numerics::BorderedSystem::Anchor& a : system.anchors) held.lower(a.band, a.band) *= 2.0;
    right = Eigen::VectorXd::LinSpaced(whole.order, -1.0, 1.0);
    right_band = right.head(held.order());
  }
};

/// Lower triangle without the zeros inside the band.
SparseMatrix lower_triangle(const numerics::SymmetricBandMatrix& matrix) {
  std::vector<std::pair<int, int>> entries;
  const int n = matrix.order();
  const int b = matrix.half_bandwidth();
  for (int j = 0; j < n; ++j) {
    for (int i = j; i <= std::min(n - 1, j + b); ++i) {
      if (matrix.lower(i, j) != 0.0) entries.emplace_back(i, j);
    }
  }
  SparseMatrix result = numerics::make_pattern(n, entries);
  for (int j = 0; j < n; ++j) {
    for (int k = result.column_start[static_cast<std::size_t>(j)];
         k < result.column_start[static_cast<std::size_t>(j) + 1]; ++k) {
      result.value[static_cast<std::size_t>(k)] = matrix.lower(result.row[static_cast<std::size_t>(k)], j);
    }
  }
  return result;
}

void WholeBareKlu(benchmark::State& state) {
  const LinearSystem s(static_cast<int>(state.range(0)));
  BareKlu klu(s.whole);
  for ([[maybe_unused]] auto _ : state) klu.run(s.right);
  state.counters["factor_entries"] = klu.entries();
  state.counters["matrix_entries"] = static_cast<double>(s.whole.row.size());
}

/// With our check of the pivot growth.
void WholeKlu(benchmark::State& state) {
  const LinearSystem s(static_cast<int>(state.range(0)));
  numerics::Klu klu(s.whole);
  Eigen::VectorXd x;
  for ([[maybe_unused]] auto _ : state) {
    if (!klu.factorize(s.whole)) state.SkipWithError("singular");
    x = s.right;
    klu.solve(x);
    benchmark::DoNotOptimize(x.data());
  }
}

/// Band L D L^T and the border: inertia and determinant as well.
void WholeOwnBordered(benchmark::State& state) {
  LinearSystem s(static_cast<int>(state.range(0)));
  Eigen::VectorXd band;
  Eigen::VectorXd border;
  for ([[maybe_unused]] auto _ : state) {
    if (!s.workspace.solver.factorize(s.workspace.system)) state.SkipWithError("singular");
    band = s.right.head(s.held.order());
    border = s.right.tail(s.whole.order - s.held.order());
    s.workspace.solver.solve(s.workspace.system, band, border);
    benchmark::DoNotOptimize(band.data());
  }
}

void StiffnessCholmod(benchmark::State& state, Cholmod::Ordering ordering) {
  const LinearSystem s(static_cast<int>(state.range(0)));
  const SparseMatrix lower = lower_triangle(s.held);
  Cholmod cholmod(lower, ordering);
  Eigen::VectorXd x;
  for ([[maybe_unused]] auto _ : state) {
    if (!cholmod.factorize(lower)) state.SkipWithError("a pivot vanishes");
    x = s.right_band;
    cholmod.solve(x);
    benchmark::DoNotOptimize(x.data());
  }
}

void StiffnessOwnBand(benchmark::State& state) {
  const LinearSystem s(static_cast<int>(state.range(0)));
  numerics::BandLdlt factor;
  Eigen::VectorXd x;
  for ([[maybe_unused]] auto _ : state) {
    if (!factor.factorize(s.held)) state.SkipWithError("a pivot vanishes");
    x = s.right_band;
    factor.solve(x);
    benchmark::DoNotOptimize(x.data());
  }
}

/// A whole Newton iteration over the yardstick; both run in turn, medians.
void NewtonIterationOverYardstick(benchmark::State& state) {
  LinearSystem s(static_cast<int>(state.range(0)));
  BareKlu klu(s.whole);
  numerics::PathWorkspace workspace;
  numerics::BandLdlt factor;
  Eigen::VectorXd by_parameter;
  numerics::BorderedSystem assembled;
  std::vector<double> times;
  for ([[maybe_unused]] auto _ : state) {
    times = median_times(
        {[&] { newton_iteration(*s.wire.system, s.wire.point, workspace); }, [&] { klu.run(s.right); },
         [&] { s.wire.system->assemble(s.wire.point, assembled, by_parameter); }},
        51, 20);
  }
  state.counters["newton_seconds"] = times[0];
  state.counters["yardstick_seconds"] = times[1];
  state.counters["assembly_seconds"] = times[2];
  state.counters["ratio"] = times[0] / times[1];
}

BENCHMARK(NewtonIterationOverYardstick)
    ->Arg(128)
    ->Arg(256)
    ->Arg(512)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(WholeBareKlu)->Arg(256)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK(WholeKlu)->Arg(256)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK(WholeOwnBordered)->Arg(256)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(StiffnessCholmod, natural, Cholmod::Ordering::natural)
    ->Arg(256)
    ->Arg(512)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(StiffnessCholmod, minimum_degree, Cholmod::Ordering::approximate_minimum_degree)
    ->Arg(256)
    ->Arg(512)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(StiffnessOwnBand)->Arg(256)->Arg(512)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace snare::benchmarks

BENCHMARK_MAIN();
