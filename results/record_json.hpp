#pragma once

#include "identification/motion_tracing/record_trace.hpp"
#include "results/result_table.hpp"

#include <nlohmann/json_fwd.hpp>

namespace snare::results {

/// trace.json of records in time: docs/record_file.md.
[[nodiscard]] nlohmann::json record_trace_json(const identification::RecordSet& set,
                                               const identification::RecordTrace& trace);
/// fit.json of them.
[[nodiscard]] nlohmann::json record_fit_json(const identification::RecordSet& set,
                                             const identification::RecordTrace& trace);

/// The columns of curves.csv: every reading of every channel beside what the declared, the base and the final
/// model say.
void give_record_curves(TableSink& sink, const identification::RecordSet& set,
                        const identification::RecordTrace& trace);

}  // namespace snare::results
