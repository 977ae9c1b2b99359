#pragma once

#include "app/report/report_page.hpp"
#include "app/report/reproduce_result.hpp"

namespace snare::app {

/// What the tracing says of the published curves, and how it depends on what the paper does not print: a section of the
/// page of `snare reproduce`. Nothing without a trace and verdicts.
void add_verdicts(ReportPage& page, const Reproduction& result);

}  // namespace snare::app
