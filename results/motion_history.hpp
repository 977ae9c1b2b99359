#pragma once

#include "results/motion_record.hpp"
#include "results/result_table.hpp"

#include <filesystem>
#include <vector>

namespace snare::results {

/// The table of history.csv of motions with wires: the runs one after the other, a line a sample. One body that meets one wire has a column
/// `model` and columns of fixed names; lists have columns for every body and contact, by their names.   docs/scenario_file.md
void give_history(TableSink& sink, const scenario::WireMotions& motions, const std::vector<FinishedMotion>& finished);

/// The same of an arm alone.
void give_history(TableSink& sink, const multibody::ElasticArm& arm, const multibody::ArmHistory& history);

/// What the sensors of a composed scenario read, at their own rates: the table of telemetry.csv.
void give_telemetry(TableSink& sink, const scenario::WireMotions& motions,
                    const std::vector<coupling::MotionSample>& samples);

// The same tables, written into files.

/// The same tables in files that appear when they are whole; std::system_error where that fails.
void write_history(const std::filesystem::path& file, const scenario::WireMotions& motions,
                   const std::vector<FinishedMotion>& finished);
/// Of an arm alone.
void write_history(const std::filesystem::path& file, const multibody::ElasticArm& arm,
                   const multibody::ArmHistory& history);
/// Of the sensors.
void write_telemetry(const std::filesystem::path& file, const scenario::WireMotions& motions,
                     const std::vector<coupling::MotionSample>& samples);

}  // namespace snare::results
