// The probability of every way in which published fits may have come about, over the range and the number of readings that their paper
// does not print: published_map_benchmark [--experiment FILE] [--only NAME,...] [--coarse] [--out FILE]

#include "base/files.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/experiment.hpp"
#include "identification/published/published_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace snare;
using namespace snare::identification;

double rounded(double value, double unit) {
  return std::isfinite(value) ? std::round(value / unit) * unit : -1e9;
}

nlohmann::json mm_of(const FitRange& range) {
  nlohmann::json all = nlohmann::json::array();
  for (const double to : range.to) all.push_back(rounded(1e3 * to, 1e-3));
  return all;
}

nlohmann::json json_of(const HypothesisMap& map, const FitRanges& ranges) {
  const MapCell& best = leading_cell(map, ranges);
  nlohmann::json values = nlohmann::json::object();
  nlohmann::json evidence(ranges.ranges().size(), nlohmann::json::array());
  for (std::size_t j = 0; j < best.values.size(); ++j) values[map.hypothesis.numbers[j].key] = best.values[j];
  for (const MapCell& c : map.cells) evidence[c.range].push_back(rounded(c.log_evidence, 0.01));
  return {{"model", map.hypothesis.name},
          {"meaning", map.hypothesis.meaning},
          {"numbers", map.hypothesis.numbers.size()},
          {"log_evidence", map.log_evidence},
          {"probability", map.probability},
          {"range", to_string(ranges.ranges()[best.range].kind)},
          {"range_mm", mm_of(ranges.ranges()[best.range])},
          {"readings", ranges.readings()[best.readings]},
          {"values_SI", values},
          {"by_range_and_readings", evidence}};
}

}  // namespace

int main(int argc, char** argv) try {
  std::string file = SNARE_BENCHMARK_DATA "/experiments/published_static.toml", out;
  std::vector<std::string> only;
  bool coarse = false;
  int replicates = 0;
  CLI::App app{"Ways in which published fits may have come about"};
  app.add_option("--experiment", file);
  app.add_option("--only", only)->delimiter(',');
  app.add_flag("--coarse", coarse);
  app.add_option("--replicates", replicates, "of the bootstrap of P of the models that are not out of question");
  app.add_option("--out", out);
  CLI11_PARSE(app, argc, argv);
  const Experiment experiment = read_experiment(file, parameters());
  MapOptions options;
  if (coarse) {
    options.ranges.ranges = 9;
    options.ranges.readings = {6, 13, 30, 68, 200};
    options.elements = 32;
    options.first = 12, options.batch = 8, options.batches = 2;
  }
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
    std::erase_if(hypotheses, [&](const Hypothesis& h) { return std::ranges::find(only, h.name) == only.end(); });
  nlohmann::json result{
      {"schema", "snare-published-map/1"}, {"readings", ranges.readings()}, {"map", nlohmann::json::array()}};
  for (const FitRange& r : ranges.ranges())
    result["ranges"].push_back({{"range", to_string(r.kind)}, {"to_mm", mm_of(r)}});
  for (const HypothesisMap& map : published_map(experiment, ranges, hypotheses, options)) {
    nlohmann::json one = json_of(map, ranges);
    if (replicates > 0 && map.probability[0] > 1e-3)
      one["p"] = published_p(experiment, ranges, map, options, replicates);
    fmt::print("{:<26} {:9.2f} {:9.2f}  {:.4f} {:.4f}  {} {:.1f} mm, {} readings, {}\n", map.hypothesis.name,
               map.log_evidence[0], map.log_evidence[1], map.probability[0], map.probability[1],
               one["range"].get<std::string>(), one["range_mm"][0].get<double>(), one["readings"].get<int>(),
               one["values_SI"].dump());
    if (one.contains("p")) fmt::print("    p = {:.3f}\n", one["p"].get<double>());
    result["map"].push_back(one);
  }
  if (!out.empty()) base::write_text(out, result.dump(1) + "\n");
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
