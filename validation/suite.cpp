#include "validation/suite.hpp"

#include "validation/push_checks.hpp"

#include <cmath>
#include <limits>

namespace snare::validation {

double Row::error() const {
  const double difference = std::abs(value - reference);
  if (!std::isfinite(difference)) return std::numeric_limits<double>::max();
  return kind == ErrorKind::relative ? difference / std::abs(reference) : difference;
}

std::vector<Check> static_wire_checks() {
  return {{"buckled shape", buckled_shape_rows},
          {"material mid-point", material_point_rows},
          {"push on the declared wire", elastica_rows},
          {"push on a soft wire that wraps the pusher", wrapped_rows},
          {"shallow limit, outward", shallow_outward_rows},
          {"shallow limit, inward", shallow_inward_rows},
          {"taut and tensioned wires", taut_rows},
          {"friction on the pusher", friction_rows},
          {"three-point bending", support_rows}};
}

}  // namespace snare::validation
