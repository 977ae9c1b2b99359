#include "validation/suite.hpp"

#include <cmath>
#include <limits>

namespace snare::validation {

double Row::error() const {
  const double difference = std::abs(value - reference);
  if (!std::isfinite(difference)) return std::numeric_limits<double>::max();
  return kind == ErrorKind::relative ? difference / std::abs(reference) : difference;
}

}  // namespace snare::validation
