#pragma once

#include "validation/suite.hpp"

#include <filesystem>
#include <vector>

namespace snare::validation {

/// A body of 8.9 kg meets the wire of the published tests (Abiko et al., section 4.3, Table 5): the quadratic
/// law against its energy balance, and the full wire beside it, over approach speeds and probe offsets that
/// the paper does not print. data: folder of the shipped files.
[[nodiscard]] std::vector<Check> air_table_checks(const std::filesystem::path& data);

/// Rows of `air_table_checks`.
[[nodiscard]] std::vector<Row> quadratic_law_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> law_beside_wire_rows(const std::filesystem::path& data);

}  // namespace snare::validation
