#pragma once

#include <string>
#include <string_view>

namespace snare::test {

/// Tables of a free body "craft" of 100 kg that turns about z at 0.01 rad/s under 0.05 N m: w = w0 + M t/J.
/// To stand below [[bodies]] and its name. `inertia`: the three moments of inertia in kg m^2, "10, 10, 10".
inline std::string turning_craft(std::string_view inertia) {
  return "mass_kg = 100.0\ninertia_kg_m2 = [" + std::string(inertia) + R"(]
spin_rad_s = [0.0, 0.0, 0.01]
[[loads]]
name = "thruster"
frame = "craft"
axes = "frame"
moment_Nm = [0.0, 0.0, 0.05]
)";
}

}  // namespace snare::test
