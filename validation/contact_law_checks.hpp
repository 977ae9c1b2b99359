#pragma once

#include "validation/suite.hpp"

#include <vector>

namespace snare::validation {

/// Impacts by the fast simulators' contact laws against closed forms: restitution by Hunt-Crossley's and by
/// the linear dashpot's law, Hertz's duration and peak. Takes a second.
[[nodiscard]] std::vector<Check> contact_law_checks();

/// Rows of `contact_law_checks`.
[[nodiscard]] std::vector<Row> hunt_crossley_rows();
[[nodiscard]] std::vector<Row> dashpot_rows();
[[nodiscard]] std::vector<Row> hertz_rows();

}  // namespace snare::validation
