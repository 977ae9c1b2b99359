#pragma once

#include "validation/suite.hpp"

#include <vector>

namespace snare::validation {

/// Everything about the static wire: buckled shape, push by knife edge and cylinder, friction, instability,
/// supports. Takes some seconds in all.
[[nodiscard]] std::vector<Check> static_wire_checks();

}  // namespace snare::validation
