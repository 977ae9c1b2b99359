#pragma once

#include "identification/fitting/finding.hpp"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace snare::results {

/// `findings` of fit.json and trace.json, of pushes and of records.
[[nodiscard]] nlohmann::json findings_json(const std::vector<identification::Finding>& findings);

/// `on_bound` of a fitted number: "none", "lower" or "upper".
[[nodiscard]] nlohmann::json bound_json(identification::AtBound bound);

}  // namespace snare::results
