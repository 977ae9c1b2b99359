#pragma once

#include "reduction/distil.hpp"

#include <optional>
#include <string>

namespace snare::reduction {

/// "s40", "s52_5": a position in a name that every language accepts.
[[nodiscard]] std::string position_name(double position);

/// Sources that need nothing but their language's standard library: the table as `force(d, s, slack)` with
/// `in_range(d, s, slack)`, and every simple law as `<law>_<position>(d)`. All in SI: m and N. Negative travel is no
/// contact, no force; beyond the range the outermost cell's polynomial goes on, which `in_range` tells.
[[nodiscard]] std::string cpp_header(const DistilledCase& one, const std::string& title);
[[nodiscard]] std::string c_source(const DistilledCase& one, const std::string& title);
[[nodiscard]] std::string python_module(const DistilledCase& one, const std::string& title);

/// A slide joint for every law position with a polynomial of three numbers, F = k0 d + k1 d^2 + k2 d^3, through the full wire, and how
/// far that and the linear law are from it; the damping of the first impact. Newer versions of MuJoCo have such springs.
[[nodiscard]] std::string mujoco_snippet(const DistilledCase& one, const std::string& title);

/// ADAMS solver splines: one of force over travel for every law position, and one of force over travel and position.
[[nodiscard]] std::string adams_splines(const DistilledCase& one, const std::string& title);

}  // namespace snare::reduction
