#pragma once

#include <vector>

namespace snare::results {

/// Lengths [m] as results name them [mm].
[[nodiscard]] inline std::vector<double> in_mm(std::vector<double> metres) {
  for (double& v : metres) v *= 1e3;
  return metres;
}

}  // namespace snare::results
