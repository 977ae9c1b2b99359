// The probability of every way in which published fits may have come about, over the range and the number of
// readings that their paper does not print: published_map_benchmark [--experiment FILE] [--only NAME,...]
// [--coarse] [--out FILE]

#include "base/files.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/experiment.hpp"
#include "identification/published/published_map.hpp"
#include "results/published_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

using namespace snare;
using namespace snare::identification;

int main(int argc, char** argv) try {
  std::string file = SNARE_BENCHMARK_DATA "/experiments/published_static.toml", out;
  std::vector<std::string> only;
  bool coarse = false;
  int replicates = 0;
  CLI::App app{"Ways in which published fits may have come about"};
  app.add_option("--experiment", file);
  app.add_option("--only", only)->delimiter(',');
  app.add_flag("--coarse", coarse);
  app.add_option("--replicates", replicates,
                 "of the bootstrap of P of the models that are not out of question");
  app.add_option("--out", out);
  CLI11_PARSE(app, argc, argv);
  const Experiment experiment = read_experiment(file, parameters());
  MapOptions options = coarse ? coarse_map() : MapOptions{};
  auto begin = std::chrono::steady_clock::now();
  std::string last;
  options.progress = [&](const std::string& name) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!last.empty()) fmt::print("{}: {:.1f} s\n", last, seconds);
    std::fflush(stdout);
    begin = std::chrono::steady_clock::now();
    last = name;
    return true;
  };
  const FitRanges ranges = fit_ranges(experiment, options);
  for (const FitRange& r : ranges.ranges())
    if (r.kind != FitRange::Kind::common) fmt::print("{}: {} m\n", to_string(r.kind), fmt::join(r.to, ", "));
  std::vector<Hypothesis> hypotheses = published_hypotheses();
  if (!only.empty())
    std::erase_if(hypotheses,
                  [&](const Hypothesis& h) { return std::ranges::find(only, h.name) == only.end(); });
  const std::vector<HypothesisMap> maps = published_map(experiment, ranges, hypotheses, options);
  std::vector<std::optional<double>> p(maps.size());
  for (std::size_t k = 0; k < maps.size(); ++k) {
    constexpr double worth = 0.02;
    if (replicates > 0 && maps[k].probability[0] > worth)
      p[k] = published_p(experiment, ranges, maps[k], options, replicates);
  }
  const nlohmann::json result = results::published_map_json(experiment, ranges, maps, p, coarse);
  for (const nlohmann::json& one : result["map"])
    fmt::print("{:<26} {:9.2f} {:9.2f}  {:.4f} {:.4f}  {} {:.1f} mm, {} readings, p {}, {:.0f} um/N, {}\n",
               one["model"].get<std::string>(), one["log_evidence"][0].get<double>(),
               one["log_evidence"][1].get<double>(), one["probability"][0].get<double>(),
               one["probability"][1].get<double>(), one["range"].get<std::string>(),
               one["range_mm"].get<double>(), one["readings"].get<int>(), one["p"].dump(),
               one["more_compliance_um_N"].get<double>(), one["values"].dump());
  const results::PublishedVerdict verdict = results::published_verdict(result);
  fmt::print("{}: {}\n", to_string(verdict.answer), verdict.headline);
  if (!out.empty()) base::write_text(out, result.dump() + "\n");
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
