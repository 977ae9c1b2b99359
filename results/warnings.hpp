#pragma once

#include "identification/tracing/trace.hpp"
#include "reduction/wire_file.hpp"
#include "results/motion_record.hpp"

#include <string>
#include <vector>

namespace snare::results {

/// What is doubtful about results that were computed as asked, one sentence each: wires that cannot be or
/// would have broken, pushers that the wire has left, blows beyond what a wire survives. Limits and their
/// sources: theory.md (W.35). `of`: whose results they are, before each sentence; may be empty.
[[nodiscard]] std::vector<std::string> push_warnings(
    const std::vector<identification::Series>& series,
    const std::vector<identification::Prediction>& predictions, const std::string& of = "");

/// The same of the fitted model of a trace.
[[nodiscard]] std::vector<std::string> trace_warnings(const identification::Experiment& experiment,
                                                      const identification::Trace& trace);

/// The same of the wires of a wire file.
[[nodiscard]] std::vector<std::string> wire_warnings(const reduction::WireFile& file);

/// The same of motions.
[[nodiscard]] std::vector<std::string> motion_warnings(const std::vector<FinishedMotion>& finished);

}  // namespace snare::results
