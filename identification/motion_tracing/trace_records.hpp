#pragma once

#include "identification/motion_tracing/record_trace.hpp"

#include <functional>
#include <string>

namespace snare::identification {

/// How far the tracing of records goes, and who watches it.
struct RecordTraceOptions {
  bool effects = true;  ///< false: the base fit only
  double significance = 0.01;
  std::function<bool(const std::string& stage)> progress = {};  ///< false stops
  std::function<bool()> stop = {};                              ///< asked during simulations, too; true stops
  std::function<void(const RecordTrace& part)> reached = {};    ///< whenever more of it is whole
};

/// Closes the loop of a scenario and its records.                                     theory.md (I.20)-(I.24)
/// Throws base::InputError for records that cannot be compared with the scenario.
[[nodiscard]] RecordTrace trace_records(const RecordSet& set, const RecordTraceOptions& options = {});

}  // namespace snare::identification
