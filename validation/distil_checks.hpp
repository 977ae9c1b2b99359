#pragma once

#include "validation/suite.hpp"

#include <vector>

namespace snare::validation {

/// The distilled laws: the published quadratics from the traced wire, the table's bound at random points, the closed
/// forms of stretched and tensioned wires, the shaft in a closed snare. Takes some seconds.
[[nodiscard]] std::vector<Check> distil_checks();

}  // namespace snare::validation
