#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace snare::app {

/// The page of `snare reproduce`, from the content of reproduce.json (docs/reproduce_json.md).
///
/// What is absent or null is left out or shown as a dash, and what stopped early is said so: a page can be had from
/// any run. Throws std::invalid_argument, naming the key, when a value has the wrong type or is not finite.
std::string reproduce_report_html(const nlohmann::json& result);

}  // namespace snare::app
