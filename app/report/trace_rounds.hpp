#pragma once

#include "app/report/report_page.hpp"
#include "identification/tracing/trace.hpp"

namespace snare::app {

/// Section "What could be missing": every pass over the catalogue with its scores, refits, reasons and
/// classes.
void add_rounds(ReportPage& page, const identification::Trace& trace);

}  // namespace snare::app
