#pragma once

#include "validation/suite.hpp"

#include <nlohmann/json_fwd.hpp>

namespace snare::app {

/// A row of validation.json, and of the figures of a paper.
[[nodiscard]] nlohmann::json row_json(const validation::Row& row);

}  // namespace snare::app
