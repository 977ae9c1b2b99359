#pragma once

#include "validation/suite.hpp"

#include <filesystem>
#include <vector>

namespace snare::validation {

/// Welds, mounts that move, and arms in the wire's DAE. data: folder of the shipped files. Takes some seconds.
[[nodiscard]] std::vector<Check> linked_motion_checks(const std::filesystem::path& data);

/// Rows of `linked_motion_checks`.
[[nodiscard]] std::vector<Row> welded_top_rows();
[[nodiscard]] std::vector<Row> moving_mount_rows();
[[nodiscard]] std::vector<Row> capture_rows(const std::filesystem::path& data);

}  // namespace snare::validation
