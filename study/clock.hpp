#pragma once

#include <chrono>

namespace snare::study {

/// Of a clock that never goes back [s].
[[nodiscard]] inline double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace snare::study
