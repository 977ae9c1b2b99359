#pragma once

#include "app/report/report_page.hpp"
#include "app/report/reproduce_result.hpp"

namespace snare::app {

/// What the tracing says of the published curves at the range that the experiment file assumes: a section of
/// the page of `snare reproduce`. Nothing without a trace.
void add_evidence(ReportPage& page, const Reproduction& result);

}  // namespace snare::app
