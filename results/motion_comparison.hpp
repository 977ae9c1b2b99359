#pragma once

#include "results/motion_record.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <vector>

namespace snare::results {

/// The motions of a scenario that lists what there is; throws base::InputError for another one. `file` stands in the message.
[[nodiscard]] const scenario::WireMotions& composed_motions(const std::filesystem::path& file,
                                                            const scenario::Scenario& asked);

/// The same motion with every model of its wires, the full one first.
[[nodiscard]] scenario::WireMotions with_every_model(const scenario::WireMotions& motions);

/// compare.json of motions with every model, as far as they were run.
[[nodiscard]] nlohmann::json comparison_json(const scenario::Scenario& asked, const scenario::WireMotions& motions,
                                             const std::vector<MotionRecord>& records);

}  // namespace snare::results
