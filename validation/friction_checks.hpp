#pragma once

#include "validation/suite.hpp"

#include <vector>

namespace snare::validation {

/// Friction in motion: rest and sliding on an incline, a block that stops, rolling, stick-slip, slow pushes
/// with their friction reversed beside the static wire. Takes some seconds.
[[nodiscard]] std::vector<Check> friction_checks();

/// Rows of `friction_checks`.
[[nodiscard]] std::vector<Row> incline_rows();
[[nodiscard]] std::vector<Row> stopping_block_rows();
[[nodiscard]] std::vector<Row> rolling_rows();
[[nodiscard]] std::vector<Row> stick_slip_rows();
[[nodiscard]] std::vector<Row> reversed_push_rows();
[[nodiscard]] std::vector<Row> strand_push_rows();

}  // namespace snare::validation
