#pragma once

#include "validation/suite.hpp"

#include <filesystem>
#include <vector>

namespace snare::validation {

/// Frequencies by the eigenvalues of the linearised equations (M.31) beside those that a small disturbance
/// shows when it is simulated.
[[nodiscard]] std::vector<Check> frequency_checks(const std::filesystem::path& data);

/// Rows of `frequency_checks`: of a held visitor, of one that strings hold on a limp arm, and of a bushing on
/// stiff joints.
[[nodiscard]] std::vector<Row> held_frequency_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> capture_frequency_rows(const std::filesystem::path& data);
[[nodiscard]] std::vector<Row> bushing_frequency_rows(const std::filesystem::path& data);

}  // namespace snare::validation
