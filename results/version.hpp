#pragma once

#include <string>

namespace snare::results {

/// Of this build, as pages and result files name it.
[[nodiscard]] std::string version();

}  // namespace snare::results
