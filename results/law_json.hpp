#pragma once

#include "reduction/distil.hpp"

#include <nlohmann/json_fwd.hpp>

namespace snare::results {

/// law.json: ranges, table, simple laws with their errors, the map of the closed forms, warnings. Fields:
/// docs/law_json.md.
[[nodiscard]] nlohmann::json law_json(const reduction::WireFile& file,
                                      const reduction::Distillation& distillation);

}  // namespace snare::results
