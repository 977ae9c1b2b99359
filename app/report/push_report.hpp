#pragma once

#include "identification/fitting/prediction.hpp"
#include "identification/tracing/trace.hpp"

#include <string>
#include <vector>

namespace snare::app {

/// The page of `snare push`: every series with its readings, and what they leave.
/// Throws std::invalid_argument, naming plot and curve, when a value is not finite.
[[nodiscard]] std::string push_report_html(const identification::Experiment& experiment,
                                           const std::vector<identification::Prediction>& predictions,
                                           const std::vector<std::string>& warnings, bool interrupted);

/// The page of `snare fit`: the same with the fitted numbers, the declared model beside the fitted one.
[[nodiscard]] std::string fit_report_html(const identification::Experiment& experiment,
                                          const identification::Trace& trace,
                                          const std::vector<std::string>& warnings);

}  // namespace snare::app
