#pragma once

#include "app/console.hpp"

#include <filesystem>

namespace snare::app {

/// `snare fit` of a file of records in time: fit.json, curves.csv.
[[nodiscard]] ExitStatus fit_records(const std::filesystem::path& file, const CommonOptions& options,
                                     Console& console);

/// `snare trace` of one: trace.json, curves.csv, report.html.
[[nodiscard]] ExitStatus trace_record_file(const std::filesystem::path& file, const CommonOptions& options,
                                           Console& console);

}  // namespace snare::app
