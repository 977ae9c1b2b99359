#pragma once

#include "results/motion_record.hpp"
#include "results/result_table.hpp"

#include <filesystem>
#include <vector>

namespace snare::results {

/// The table of history.csv, a line a sample: columns for every body, contact, joint, wire and bushing, by
/// their names; energies.
///                                                                                      docs/scenario_file.md
void give_history(TableSink& sink, const coupling::Motion& motion,
                  const std::vector<coupling::MotionSample>& samples);

/// What the sensors of a scenario read, at their own rates: the table of telemetry.csv.
void give_telemetry(TableSink& sink, const scenario::WireMotions& motions,
                    const std::vector<coupling::MotionSample>& samples);

/// The same tables in files that appear when they are whole; std::system_error where that fails.
void write_history(const std::filesystem::path& file, const coupling::Motion& motion,
                   const std::vector<coupling::MotionSample>& samples);
void write_telemetry(const std::filesystem::path& file, const scenario::WireMotions& motions,
                     const std::vector<coupling::MotionSample>& samples);

}  // namespace snare::results
