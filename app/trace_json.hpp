#pragma once

#include "identification/tracing/trace.hpp"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace snare::app {

/// A trace as trace.json (docs/trace_json.md), the curves of the series among it. What is not known is null.
[[nodiscard]] nlohmann::json trace_json(const identification::Experiment& experiment,
                                        const identification::Trace& trace);

/// A fit of the declared model as fit.json.
[[nodiscard]] nlohmann::json fit_json(const identification::Experiment& experiment, const identification::Trace& trace);

/// How a trace is made a fit of the declared model alone.
[[nodiscard]] identification::TraceOptions fit_options();

/// "wire.length_mm": {"value", "stderr", "declared", "unit", "lower95", "upper95", "profiled"}, ... of fitted numbers.
[[nodiscard]] nlohmann::json numbers_json(const std::vector<identification::FittedNumber>& numbers);

}  // namespace snare::app
