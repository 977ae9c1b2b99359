#pragma once

#include "validation/suite.hpp"

#include <filesystem>
#include <vector>

namespace snare::validation {

/// Arms with elastic joints: conservation, closed forms, the joint step of Abiko et al., jumps of its Table
/// 2, pushes.
/// arms: folder of the shipped arm files. Takes some seconds.
[[nodiscard]] std::vector<Check> arm_checks(const std::filesystem::path& arms);

/// Rows of `arm_checks`.
[[nodiscard]] std::vector<Row> arm_conservation_rows();
[[nodiscard]] std::vector<Row> arm_work_rows();
[[nodiscard]] std::vector<Row> arm_frequency_rows();
[[nodiscard]] std::vector<Row> rigid_limit_rows();
[[nodiscard]] std::vector<Row> amplitude_rows();
[[nodiscard]] std::vector<Row> floating_base_rows();
[[nodiscard]] std::vector<Row> jump_rows();
[[nodiscard]] std::vector<Row> joint_step_rows(const std::filesystem::path& arms);
[[nodiscard]] std::vector<Row> tip_push_rows(const std::filesystem::path& arms);

}  // namespace snare::validation
