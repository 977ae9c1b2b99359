#pragma once

#include "numerics/dae.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace snare::coupling {

/// Three numbers in the memory of a part, of any unit; see numerics::DaePart.
inline void put_vector(std::vector<double>& memory, const Eigen::Vector3d& v) {
  memory.insert(memory.end(), {v.x(), v.y(), v.z()});
}
[[nodiscard]] inline Eigen::Vector3d take_vector(std::span<const double>& memory) {
  const double x = numerics::take(memory), y = numerics::take(memory), z = numerics::take(memory);
  return {x, y, z};
}

}  // namespace snare::coupling
