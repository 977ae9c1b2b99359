#pragma once

#include "identification/tracing/trace.hpp"

#include <string>

namespace snare::app {

/// The page of `snare trace`.
///
/// A trace that was interrupted, or that lacks predictions, gives a page, too: what is not known is left out
/// or shown as a dash. Throws std::invalid_argument, naming plot and curve, when a value of a curve is not
/// finite.
[[nodiscard]] std::string trace_report_html(const identification::Experiment& experiment,
                                            const identification::Trace& trace, const std::string& version,
                                            const std::vector<std::string>& warnings = {});

}  // namespace snare::app
