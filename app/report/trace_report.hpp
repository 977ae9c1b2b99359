#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace snare::app {

/// The page of `snare trace`, from the content of trace.json (docs/trace_json.md).
///
/// What is absent or null is left out or shown as a dash. Throws std::invalid_argument, naming the key, when a value has
/// the wrong type or is not finite.
std::string trace_report_html(const nlohmann::json& result);

}  // namespace snare::app
