#pragma once

#include <string>

namespace snare::test {

/// A wire file of the wire that the tracing of the published tests ends with; `more` tables stand at its end.
inline std::string traced_wire_text(const std::string& title, const std::string& more) {
  return "schema = \"snare-wire/1\"\ntitle = \"" + title + R"("
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
)" + more;
}

}  // namespace snare::test
