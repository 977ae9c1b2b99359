#pragma once

#include "base/toml_tree.hpp"
#include "results/motion_record.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace snare::results {

/// A scenario once for each model of its wires, the full one first.
struct MotionComparison {
  scenario::WireMotions motions;
  std::vector<std::pair<std::string, std::string>> left_out;  ///< models that it cannot have, with the reason
};
/// Of a scenario, read from its file anew for each model. Throws base::InputError where it has no wires.
[[nodiscard]] MotionComparison with_every_model(const std::filesystem::path& file,
                                                const std::vector<base::Override>& overrides,
                                                const scenario::WireMotions& motions);

/// compare.json of motions with every model, as far as they were run.
[[nodiscard]] nlohmann::json comparison_json(const scenario::Scenario& asked,
                                             const MotionComparison& comparison,
                                             const std::vector<MotionRecord>& records);

}  // namespace snare::results
