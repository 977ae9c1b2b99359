#pragma once

#include <cassert>
#include <cstddef>

namespace snare::base {

/// An index of a standard container from a count that Eigen and the solvers keep as int, >= 0.
[[nodiscard]] inline std::size_t at(int index) {
  assert(index >= 0);
  return static_cast<std::size_t>(index);
}

}  // namespace snare::base
