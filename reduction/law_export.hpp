#pragma once

#include "reduction/distil.hpp"

#include <string>

namespace snare::reduction {

// Sources that need nothing but their language's standard library: the table as force(d, position, slack),
// force_unloading where something dissipates, and every simple law as LAW_POSITION(d). SI units: m, N.
// Without contact (d < 0) a force is 0.
//
// Outside its range a law continues linearly, never negative and never falling along the travel
// (ForceTable::at, RangedLaw); in_range(d, position, slack) and travel_in_range(d) are the flag. Every
// function can refuse instead: by an argument in C++ (std::domain_error) and Python (ValueError), in C by the
// functions with _or_nan, in Modelica by those with _or_stop (assert).
//
// name: keeps the laws of one program apart, an identifier: the namespace in C++ and the package in Modelica
// (snare_law if it is empty), in C the beginning of every name, before an underscore (nothing if it is
// empty).

/// law.hpp, header only, C++17.
[[nodiscard]] std::string cpp_header(const DistilledCase& one, const std::string& title,
                                     const std::string& name = "");
/// law.c, C99.
[[nodiscard]] std::string c_source(const DistilledCase& one, const std::string& title,
                                   const std::string& name = "");
/// law.h declares what c_source defines, for C and C++.
[[nodiscard]] std::string c_header(const DistilledCase& one, const std::string& title,
                                   const std::string& name = "");
/// law.py, Python 3.6. In Python a continued force issues the warning OutsideRange as well.
[[nodiscard]] std::string python_module(const DistilledCase& one, const std::string& title);
/// law.mo, a package of functions of Modelica 3.2 without any library; the load/unload law, which has a
/// memory, is left out.
[[nodiscard]] std::string modelica_package(const DistilledCase& one, const std::string& title,
                                           const std::string& name = "");

}  // namespace snare::reduction
