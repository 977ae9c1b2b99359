#pragma once

#include "reduction/wire_file.hpp"

#include <string>

namespace snare::reduction {

/// A small distillation: coarse meshes and few knots, for tests that run under the sanitizers.
inline std::string small_wire_text(const std::string& more = "") {
  return R"(schema = "snare-wire/1"
title = "small"
[wire]
construction = "solid"
diameter_mm = 1.5
length_mm = 175.49
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
bending_stiffness_Nm2 = 0.0094
axial_stiffness_N = 19300.0
[mount]
kind = "clamped"
span_mm = 175.0
[pusher]
shape = "cylinder"
radius_mm = 6.0
friction = 0.0
direction = "outward"
[solver]
elements = 32
[table]
points = [6, 4, 3]
most_points = [6, 4, 3]
)" + more;
}

inline WireFile small_wire(const std::string& more = "") {
  return parse_wire_file("small.toml", small_wire_text(more));
}

}  // namespace snare::reduction
