#pragma once

#include "base/toml_tree.hpp"
#include "study/collect.hpp"
#include "study/design.hpp"
#include "study/refined_grid.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace snare::study {

/// A bound of a collected field. Beyond it a case counts as exceeding.
struct Limit {
  std::string name;
  std::size_t field = 0;  ///< index of what is collected
  bool above = true;      ///< exceeding: the field is above the bound, else below
  double bound = 0.0;     ///< in the field's unit
};

/// How failure probabilities that are small are approached.                                   theory.md (S.5)
struct SubsetSettings {
  double level_probability = 0.1;  ///< share of the cases of a level from which the next one starts, (0, 0.5]
  int most_levels = 12;
};

/// A grid of which only those cases are run that tell where a field changes.                  theory.md (S.7)
struct RefineSettings {
  std::size_t field = 0;  ///< index of what is collected
  RefinedGrid::Settings grid;
};

/// What is kept of the histories of the cases: the tables that their verb writes beside its JSON.
struct HistorySettings {
  std::vector<std::string> columns;  ///< by their names in the table; none: all
  int every = 1;                     ///< of so many rows the first is kept, >= 1
};

/// A sweep file as it was read.                                                        docs/sweep_file.md
struct SweepFile {
  std::filesystem::path file;
  std::string title, source;
  std::filesystem::path case_file;    ///< scenario, experiment, wire or record file
  std::string verb;                   ///< what runs a case; empty: what its file's schema says
  std::vector<base::Override> fixed;  ///< for all cases
  Design design;
  std::vector<Collected> collect;
  std::vector<Limit> limits;
  SubsetSettings subset;
  std::optional<RefineSettings> refine;      ///< none: every case of the design is run
  std::optional<HistorySettings> histories;  ///< none: no histories are kept
  double time_limit = 0.0;                   ///< of one case [s], > 0
  std::string canonical;  ///< equal for files that say the same, trace and table beside them included
};

/// Reads and checks a sweep file, and the table and traces that it names; the case is another reader's.
/// Throws base::InputError with everything that is wrong.
[[nodiscard]] SweepFile read_sweep_file(const std::filesystem::path& file,
                                        const std::vector<base::Override>& overrides = {});

/// What a case changes in its file: what all share, then its own values.
[[nodiscard]] std::vector<base::Override> overrides_of(const SweepFile& sweep,
                                                       const std::vector<double>& values);

inline constexpr double case_limit = 1e9;  ///< most cases of a sweep

}  // namespace snare::study
