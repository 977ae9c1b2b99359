#pragma once

#include "reduction/distil.hpp"

#include <string>

namespace snare::reduction {

/// "s40", "s52_5": a position [m], told in mm, in a name that every language accepts.
[[nodiscard]] std::string position_name(double position);

/// Sources that need nothing but their language's standard library: the table as `force(d, s, slack)` with
/// `in_range(d, s, slack)`, and every simple law as `<law>_<position>(d)`. All in SI: m and N. Negative travel is no
/// contact, no force; beyond the range the outermost cell's polynomial goes on, which `in_range` tells.
///
/// name: what keeps the laws of one program apart, an identifier: the namespace in C++ (snare_law if it is empty), in C what
/// every name begins with, with a low line behind it (nothing if it is empty).
[[nodiscard]] std::string cpp_header(const DistilledCase& one, const std::string& title, const std::string& name = "");
[[nodiscard]] std::string c_source(const DistilledCase& one, const std::string& title, const std::string& name = "");
/// Declares what c_source defines, for C and C++.
[[nodiscard]] std::string c_header(const DistilledCase& one, const std::string& title, const std::string& name = "");
[[nodiscard]] std::string python_module(const DistilledCase& one, const std::string& title);

}  // namespace snare::reduction
