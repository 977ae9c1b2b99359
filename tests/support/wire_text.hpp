#pragma once

#include <string>

namespace snare::test {

/// Tables of a file about the wire of the published tests; `more_of_wire` ends the first one.
inline std::string wire_tables(const std::string& length_mm, const std::string& more_of_wire = "") {
  return R"([wire]
construction = "solid"
diameter_mm = 1.5
length_mm = )" +
         length_mm + R"(
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
)" + more_of_wire +
         R"([mount]
kind = "clamped"
span_mm = 175.0
[pusher]
shape = "cylinder"
radius_mm = 6.0
friction = 0.0
direction = "outward"
)";
}

/// A wire file of a fitted wire near that of the published tests; `more` tables stand at its end.
inline std::string traced_wire_text(const std::string& title, const std::string& more) {
  return "schema = \"snare-wire/1\"\ntitle = \"" + title + "\"\n" +
         wire_tables("175.49", "bending_stiffness_Nm2 = 0.0094\naxial_stiffness_N = 19300.0\n") + more;
}

}  // namespace snare::test
