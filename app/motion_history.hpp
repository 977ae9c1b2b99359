#pragma once

#include "app/report/motion_record.hpp"

#include <filesystem>
#include <vector>

namespace snare::app {

/// history.csv of motions with wires: the runs one after the other, a line a sample. One body that meets one wire has a column
/// `model` and columns of fixed names; lists have columns for every body and contact, by their names.   docs/scenario_file.md
void write_history(const std::filesystem::path& file, const scenario::WireMotions& motions,
                   const std::vector<FinishedMotion>& finished);

/// history.csv of an arm alone.
void write_history(const std::filesystem::path& file, const multibody::ElasticArm& arm,
                   const multibody::ArmHistory& history);

/// What the sensors of a composed scenario read, at their own rates.
void write_telemetry(const std::filesystem::path& file, const scenario::WireMotions& motions,
                     const std::vector<coupling::MotionSample>& samples);

}  // namespace snare::app
