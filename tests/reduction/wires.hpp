#pragma once

#include "reduction/wire_file.hpp"
#include "tests/support/wire_text.hpp"

#include <string>

namespace snare::reduction {

/// A small distillation: coarse meshes and few knots, for tests that run under the sanitizers.
inline std::string small_wire_text(const std::string& more = "") {
  return test::traced_wire_text("small", R"([solver]
elements = 32
[table]
points = [6, 4, 3]
most_points = [6, 4, 3]
)" + more);
}

inline WireFile small_wire(const std::string& more = "") {
  return parse_wire_file("small.toml", small_wire_text(more));
}

}  // namespace snare::reduction
