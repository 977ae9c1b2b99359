#pragma once

#include "base/toml_tree.hpp"
#include "reduction/compare.hpp"
#include "results/watch.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace snare::results {

/// Pushes on which the models of a wire are compared.
struct StaticComparison {
  std::string title;
  std::vector<reduction::StaticCase> cases;
  reduction::DistilSettings settings;
};

/// Every series of an experiment file with its readings or its published law, or every position of a wire
/// file at its nominal slack. Throws base::InputError.
[[nodiscard]] StaticComparison read_static_comparison(const std::filesystem::path& file,
                                                      const std::vector<base::Override>& overrides = {});

/// compare.json of the cases that were run, the first ones.
[[nodiscard]] nlohmann::json comparison_json(const StaticComparison& comparison,
                                             const std::vector<reduction::CaseComparison>& results);

}  // namespace snare::results
