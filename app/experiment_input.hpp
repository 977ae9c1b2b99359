#pragma once

#include "app/console.hpp"
#include "base/toml_tree.hpp"
#include "identification/fitting/experiment.hpp"

#include <filesystem>
#include <vector>

namespace snare::app {

/// `key=value` texts of --set, parsed. Throws base::InputError for one without '='.
[[nodiscard]] std::vector<base::Override> overrides_of(const CommonOptions& options);

/// The experiment with the overrides of --set. Throws base::InputError.
[[nodiscard]] identification::Experiment open_experiment(const std::filesystem::path& file,
                                                         const CommonOptions& options);

}  // namespace snare::app
