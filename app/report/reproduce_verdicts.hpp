#pragma once

#include "app/report/report_page.hpp"

#include <nlohmann/json_fwd.hpp>

namespace snare::app {

/// What the tracing says of the published curves, and how it depends on what the paper does not print: the part of the page of
/// `snare reproduce` made from `trace` and `verdicts` (docs/reproduce_json.md). Nothing when both are absent.
void add_verdicts(ReportPage& page, const nlohmann::json& result);

}  // namespace snare::app
