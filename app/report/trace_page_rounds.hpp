#pragma once

#include "app/report/report_page.hpp"

#include <nlohmann/json_fwd.hpp>

namespace snare::app::trace_page {

/// Section "What could be missing": every pass over the catalogue with its scores, refits, reasons and classes.
void add_rounds(ReportPage& page, const nlohmann::json& result);

}  // namespace snare::app::trace_page
