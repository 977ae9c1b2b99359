#pragma once

#include "validation/suite.hpp"

#include <vector>

namespace snare::validation {

/// Rows of `static_wire_checks`, each group against closed forms or the elastica by multiple shooting.
[[nodiscard]] std::vector<Row> buckled_shape_rows();
[[nodiscard]] std::vector<Row> material_point_rows();
[[nodiscard]] std::vector<Row> elastica_rows();
[[nodiscard]] std::vector<Row> wrapped_rows();
[[nodiscard]] std::vector<Row> shallow_outward_rows();
[[nodiscard]] std::vector<Row> shallow_inward_rows();
[[nodiscard]] std::vector<Row> taut_rows();
[[nodiscard]] std::vector<Row> friction_rows();
[[nodiscard]] std::vector<Row> support_rows();

}  // namespace snare::validation
