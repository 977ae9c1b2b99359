#pragma once

#include "app/console.hpp"
#include "identification/experiment.hpp"
#include "numerics/toml_tree.hpp"

#include <filesystem>
#include <vector>

namespace snare::app {

/// `key=value` texts of --set, parsed. Throws numerics::InputError for one without '='.
[[nodiscard]] std::vector<numerics::Override> overrides_of(const CommonOptions& options);

/// The experiment with the overrides of --set; from here on --threads holds. Throws numerics::InputError.
[[nodiscard]] identification::Experiment open_experiment(const std::filesystem::path& file,
                                                         const CommonOptions& options);

}  // namespace snare::app
