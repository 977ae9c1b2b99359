#pragma once

#include "identification/tracing/trace.hpp"
#include "results/curves.hpp"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace snare::results {

/// A trace as trace.json (docs/trace_json.md), the curves of the series among it. What is not known is null.
[[nodiscard]] nlohmann::json trace_json(const identification::Experiment& experiment,
                                        const identification::Trace& trace);

/// The same with what is doubtful under "warnings", as the file has it.
[[nodiscard]] nlohmann::json trace_document(const identification::Experiment& experiment,
                                            const identification::Trace& trace);

/// Options of a trace that fits the declared model and adds nothing to it.
[[nodiscard]] identification::TraceOptions fitting_options();

/// A trace with these options as fit.json (docs/trace_json.md). What is doubtful is under "warnings".
[[nodiscard]] nlohmann::json fit_json(const identification::Experiment& experiment,
                                      const identification::Trace& trace);

/// The columns `base_N` and `final_N` that curves.csv has after a trace or a fit.
[[nodiscard]] std::vector<CurveColumn> curve_columns(const identification::Trace& trace);

/// "wire.length_mm": {"value", "stderr", "declared", "unit", "lower95", "upper95", "profiled", "averaged"},
/// ... of fitted numbers.
[[nodiscard]] nlohmann::json numbers_json(const std::vector<identification::FittedNumber>& numbers);

}  // namespace snare::results
