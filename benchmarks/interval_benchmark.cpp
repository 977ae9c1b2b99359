// How often the intervals of sweeps contain the truth: subset simulations, shares of hits and Sobol indices
// of functions with closed forms.
//   interval_benchmark [--studies N] [--first SEED] [--out FILE]
// Intervals are said to be of 95 %; those of shares hold at least that often.

#include "base/files.hpp"
#include "benchmarks/interval_coverage.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

using namespace snare;
using nlohmann::json;

namespace {

json subsets(const benchmarks::Seeds& seeds) {
  constexpr std::uint64_t cases = 1000;
  json all = json::array();
  for (const double probability : {1e-2, 1e-4, 1e-6}) {
    for (const benchmarks::LimitFunction& smooth : benchmarks::limit_functions(probability)) {
      for (const benchmarks::LimitFunction& limit : {smooth, benchmarks::yes_or_no(smooth)}) {
        const double held = benchmarks::subset_coverage(limit, cases, seeds).share();
        fmt::print("subset, {}, P = {:g}: {:.3f}\n", limit.name, probability, held);
        all.push_back(
            {{"limit", limit.name}, {"probability", probability}, {"cases", cases}, {"held", held}});
      }
    }
  }
  return all;
}

json shares(const benchmarks::Seeds& seeds) {
  constexpr std::uint64_t cases = 1000;
  json all = json::array();
  using study::DesignKind;
  for (const auto& [name, kind] :
       {std::pair{"latin_hypercube", DesignKind::latin_hypercube}, std::pair{"sobol", DesignKind::sobol}}) {
    for (const double probability : {1e-1, 1e-2, 1e-4}) {
      for (const benchmarks::LimitFunction& limit : benchmarks::limit_functions(probability)) {
        const double held = benchmarks::share_coverage(limit, kind, cases, seeds).share();
        fmt::print("share, {}, {}, P = {:g}: {:.3f}\n", name, limit.name, probability, held);
        all.push_back(
            {{"design", name}, {"limit", limit.name}, {"probability", probability}, {"held", held}});
      }
    }
  }
  return all;
}

json indices(const benchmarks::Seeds& seeds) {
  json all = json::array();
  const std::vector<double> a{0.0, 1.0, 4.5, 9.0, 99.0, 99.0};
  for (const benchmarks::IndexFunction& f : {benchmarks::ishigami(), benchmarks::g_function(a),
                                             benchmarks::box(0.1, 2), benchmarks::box(0.01, 2)}) {
    for (const std::uint64_t rows : {256u, 1024u, 4096u}) {
      const benchmarks::IndexCoverage c = benchmarks::index_coverage(f, rows, seeds);
      if (c.first.studies == 0) continue;
      fmt::print("Sobol, {}, {} rows: {:.3f} {:.3f}\n", f.name, rows, c.first.share(), c.total.share());
      all.push_back({{"function", f.name},
                     {"rows", rows},
                     {"held_first", c.first.share()},
                     {"held_total", c.total.share()},
                     {"mean_half_first", c.half},
                     {"intervals", c.first.studies}});
    }
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"coverage of the intervals of sweeps"};
  benchmarks::Seeds seeds;
  std::string out;
  app.add_option("--studies", seeds.count, "studies a row, one a seed")->check(CLI::Range(1, 100000));
  app.add_option("--first", seeds.first, "the first seed")->check(CLI::Range(1, 1000000));
  app.add_option("--out", out, "file for the result");
  CLI11_PARSE(app, argc, argv);
  const json result{{"studies", seeds.count},
                    {"first_seed", seeds.first},
                    {"subset", subsets(seeds)},
                    {"shares", shares(seeds)},
                    {"sobol_indices", indices(seeds)}};
  if (!out.empty()) base::write_text(out, result.dump(1) + "\n");
}
