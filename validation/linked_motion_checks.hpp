#pragma once

#include "validation/suite.hpp"

#include <vector>

namespace snare::validation {

/// Welds and mounts that move. Takes some seconds.
[[nodiscard]] std::vector<Check> linked_motion_checks();

/// Rows of `linked_motion_checks`.
[[nodiscard]] std::vector<Row> welded_top_rows();
[[nodiscard]] std::vector<Row> moving_mount_rows();

}  // namespace snare::validation
