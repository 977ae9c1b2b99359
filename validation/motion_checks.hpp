#pragma once

#include "validation/suite.hpp"

#include <vector>

namespace snare::validation {

/// The wire in motion: frequencies, waves, chain, pendulum, quasi-static limit, impact. Takes about a minute.
[[nodiscard]] std::vector<Check> motion_checks();

/// Rows of `motion_checks`.
[[nodiscard]] std::vector<Row> clamped_frequency_rows();
[[nodiscard]] std::vector<Row> tensioned_frequency_rows();
[[nodiscard]] std::vector<Row> buckled_frequency_rows();
[[nodiscard]] std::vector<Row> axial_wave_rows();
[[nodiscard]] std::vector<Row> gravity_rows();
[[nodiscard]] std::vector<Row> slow_push_rows();
[[nodiscard]] std::vector<Row> impact_rows();

}  // namespace snare::validation
