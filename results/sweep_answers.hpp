#pragma once

#include "results/result_table.hpp"
#include "results/sweep_study.hpp"
#include "study/proportion.hpp"
#include "study/sobol_indices.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace snare::results {

/// A field over the cases that have it.
struct FieldAnswer {
  std::string name;
  std::uint64_t count = 0;
  bool yes_or_no = true;   ///< a boolean in every case
  std::uint64_t hits = 0;  ///< cases in which a boolean is true
  double mean = 0.0, deviation = 0.0;
  double least = 0.0, most = 0.0;
  std::vector<double> sample;  ///< ascending; every n-th case, so that there are at most sample_limit
  std::optional<study::SobolIndices> indices;

  static constexpr std::uint64_t sample_limit = 100000;
  /// Of the sample, in the field's unit; 0 < p < 1.
  [[nodiscard]] double quantile(double p) const;
};

/// How often a field is beyond a bound.
struct LimitAnswer {
  std::string name;
  std::uint64_t count = 0, hits = 0;  ///< cases that have the field, that are beyond the bound
};

/// What is shown of a case by itself.
struct CaseAnswer {
  std::uint64_t number = 0;  ///< from 1
  std::string why;           ///< "largest peak_N: 2613"
  std::string command;
};

/// A field or a limit over two variables: means over the cases in a cell, or the share of hits.
struct MapAnswer {
  std::string title;
  std::string x, y;                        ///< names of the variables
  std::vector<double> x_edges, y_edges;    ///< of the cells; one more than these
  bool share = false;                      ///< of hits, else a mean
  std::vector<std::uint64_t> count, hits;  ///< a cell, x fastest
  std::vector<std::uint64_t> inferred;     ///< of count, cases that were not run
  std::vector<double> sum;
};

/// A field over a variable, a point a case.
struct ScatterAnswer {
  std::string x, y;               ///< names of the variable, of the field
  std::vector<double> at, value;  ///< in the units of the files, which the names say
};

/// What a subset simulation says of a rare event.
struct SubsetAnswer {
  double probability = 0.0, variation = 0.0;  ///< of the event; coefficient of variation of that [-]
  study::ProbabilityInterval
      interval;          ///< 95 % interval; not reached: from zero to a bound that holds more often
  bool reached = false;  ///< some case had the event
  std::vector<study::SubsetSimulation::Level> levels;
};

/// The cases of a sweep: those of its journal, and those that are inferred from them.
struct SweepCases {
  const study::Journal& journal;
  std::uint64_t count = 0;                      ///< there are, as far as is known
  const study::RefinedGrid* refined = nullptr;  ///< a refined grid at its end, else none
};

/// What the cases of a sweep say together.
struct SweepAnswers {
  std::uint64_t cases = 0;     ///< there are; 0: unknown before the end
  std::uint64_t finished = 0;  ///< were run
  bool interrupted = false;
  std::map<std::string, std::uint64_t> statuses;
  std::map<std::string, std::uint64_t> reasons;  ///< of cases that are not done, how often; the first hundred
  double seconds = 0.0;                          ///< of all cases, one after the other
  std::vector<FieldAnswer> fields;
  std::vector<LimitAnswer> limits;
  std::vector<CaseAnswer> worst;
  std::vector<MapAnswer> maps;
  std::vector<ScatterAnswer> scatters;
  std::optional<SubsetAnswer> subset;

  [[nodiscard]] std::uint64_t inferred() const;  ///< cases of a refined grid that were not run
};

/// Number of a variable in a case, in the unit of its key, as it stands in tables: levels that are texts have
/// none.
[[nodiscard]] std::optional<double> shown_number(const study::Variable& variable, double value);

/// Values of a case, in the units of their keys: of the design, or of its record.
[[nodiscard]] std::vector<double> values_of_case(const SweepStudy& study, std::uint64_t index,
                                                 const study::CaseRecord& record);

/// Goes through the journal a few times; holds samples and sums only.
[[nodiscard]] SweepAnswers sweep_answers(const SweepStudy& study, const SweepCases& cases);

/// summary.json.                                                                        docs/sweep_file.md
[[nodiscard]] nlohmann::json sweep_summary(const SweepStudy& study, const SweepAnswers& answers);

/// The columns of cases.csv: the cases that were run or are inferred, in order.
void give_cases(TableSink& sink, const SweepStudy& study, const SweepCases& cases);

/// What a case says of the field by which the grid of the sweep is refined.
[[nodiscard]] study::Seen seen_of(const SweepStudy& study, const study::CaseRecord& record);

}  // namespace snare::results
