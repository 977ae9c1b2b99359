#pragma once

#include "app/report/reproduce_result.hpp"

#include <nlohmann/json_fwd.hpp>

namespace snare::app {

/// A reproduction as reproduce.json (docs/reproduce_json.md).
[[nodiscard]] nlohmann::json reproduce_json(const Reproduction& result);

}  // namespace snare::app
