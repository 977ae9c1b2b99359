#pragma once

#include "coupling/statics/snared_shaft.hpp"
#include "validation/suite.hpp"

#include <vector>

namespace snare::validation {

/// The distilled laws: the table's bound at random points, the closed forms of stretched and tensioned wires,
/// the shaft in a closed snare. Takes some seconds.
[[nodiscard]] std::vector<Check> distil_checks();

/// Half the traced wire in every length, so that stresses stay: EI by 1/16, EA by 1/4. Seat and friction are
/// assumed.
[[nodiscard]] coupling::SnareSpecification half_scale_snare();

}  // namespace snare::validation
