#pragma once

#include "identification/motion_tracing/motion_trace.hpp"

#include <nlohmann/json_fwd.hpp>

namespace snare::app {

/// trace.json of records in time: docs/record_file.md.
[[nodiscard]] nlohmann::json record_trace_json(const identification::RecordSet& set,
                                               const identification::MotionTrace& trace);
/// fit.json of them.
[[nodiscard]] nlohmann::json record_fit_json(const identification::RecordSet& set,
                                             const identification::MotionTrace& trace);

}  // namespace snare::app
