#pragma once

#include "identification/motion_tracing/record_trace.hpp"

#include <string>

namespace snare::app {

/// The verdict on records in time in one sentence, in words of the trade.
[[nodiscard]] std::string record_verdict(const identification::RecordTrace& trace);

/// report.html of records in time: verdict, numbers, effects, every channel measured, declared and traced
/// over time with what is left.
[[nodiscard]] std::string record_report_html(const identification::RecordSet& set,
                                             const identification::RecordTrace& trace);

}  // namespace snare::app
