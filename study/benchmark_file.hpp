#pragma once

#include "base/toml_tree.hpp"
#include "study/collect.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace snare::study {

/// What a history is asked for, by the names that the benchmark gives.
using Columns = std::map<std::string, std::string>;

/// A model that is scored on a case: a file that is run, or a history that somebody has computed.
struct BenchmarkModel {
  std::string name;
  std::filesystem::path file;         ///< that is run; empty: `csv`
  std::vector<base::Override> fixed;  ///< after those of the case
  Columns columns;                    ///< of its history
  std::filesystem::path csv;          ///< with x and the quantities by their names here
};

/// A case, its archived history and who is scored on it.
struct BenchmarkCase {
  std::string name, title;
  std::filesystem::path file;  ///< that the archive is made with
  std::vector<base::Override> fixed;
  std::string x;    ///< first column of every history of the case
  Columns columns;  ///< of the history by the names of the quantities
  std::map<std::string, double>
      touch_above;                 ///< of quantities for which touches are looked for, in their units
  std::vector<Collected> outcome;  ///< fields of the result that must be those of the archive
  std::vector<std::vector<base::Override>> refinements;  ///< with which the archive is made, coarse to fine
  std::vector<BenchmarkModel> models;
  std::optional<double> step_at;  ///< when the largest explicit step is asked for [s]; none: it is not
};

/// A file of `snare benchmark`, "snare-benchmark/1".
/// docs/benchmark_file.md
struct BenchmarkFile {
  std::filesystem::path file;
  std::string title, source;
  std::filesystem::path references;  ///< folder of the archive
  std::vector<BenchmarkCase> cases;
};

/// Reads it. Throws base::InputError with everything that is wrong.
[[nodiscard]] BenchmarkFile read_benchmark_file(const std::filesystem::path& file,
                                                const std::vector<base::Override>& overrides = {});

}  // namespace snare::study
