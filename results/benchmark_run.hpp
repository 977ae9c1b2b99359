#pragma once

#include "results/case_runner.hpp"
#include "results/watch.hpp"
#include "study/benchmark_file.hpp"
#include "study/benchmark_score.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace snare::results {

/// Quantities by their names.
using Tracks = std::map<std::string, study::Track>;
/// How each of them differs from the archive.
using Scores = std::map<std::string, study::TrackScore>;

/// The archived history of a case.
struct BenchmarkReference {
  Tracks tracks;
  Scores bars;  ///< the scores of the last refinement but one
  std::map<std::string, nlohmann::json> outcome;
  bool stale = false;  ///< it was made from other input than there is now
};

/// What a model has come to on a case.
struct BenchmarkRow {
  std::string model;
  CaseEnd end;
  double seconds = 0.0;                ///< of the clock [s]; 0 where nothing was run
  std::optional<double> energy_error;  ///< of the integration, over the most kinetic and strain energy [-]
  std::optional<double> largest_step;  ///< of an explicit method, where the case asks for it [s]
  Tracks tracks;
  Scores scores;                                  ///< where it is done
  std::map<std::string, nlohmann::json> outcome;  ///< of the fields that the case asks for
};

/// A case with those of its models that were run.
struct BenchmarkAnswer {
  const study::BenchmarkCase* asked = nullptr;
  BenchmarkReference reference;
  std::vector<BenchmarkRow> rows;
};

/// Reads what all models of a case would read. Throws base::InputError where one cannot be run, or has no
/// such columns.
void check_benchmark_case(const study::BenchmarkFile& benchmark, const study::BenchmarkCase& c);

/// The archive of a case. Throws base::InputError where there is none, or where it is damaged.
[[nodiscard]] BenchmarkReference read_reference(const study::BenchmarkFile& benchmark,
                                                const study::BenchmarkCase& c);

/// Runs the refinements of a case and writes the archive: NAME.csv and NAME.json. Says why where one does not
/// end.
[[nodiscard]] CaseEnd archive_case(const study::BenchmarkFile& benchmark, const study::BenchmarkCase& c,
                                   const Watch& watch);

/// Runs, or reads, a model of a case and scores it.
[[nodiscard]] BenchmarkRow run_benchmark_model(const study::BenchmarkCase& c,
                                               const study::BenchmarkModel& model,
                                               const BenchmarkReference& reference, const Watch& watch);

/// benchmark.json: the answers so far, and how many rows there were to be.
[[nodiscard]] nlohmann::json benchmark_json(const study::BenchmarkFile& benchmark,
                                            const std::vector<BenchmarkAnswer>& answers, std::size_t asked);

/// scores.csv: a line a quantity of a model.
void give_scores(TableSink& sink, const std::vector<BenchmarkAnswer>& answers);

}  // namespace snare::results
