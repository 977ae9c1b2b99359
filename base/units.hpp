#pragma once

#include <numbers>

/// Units in which files are written, in SI. Inside the program all numbers are in SI.
namespace snare::base {

inline constexpr double mm = 1e-3;                          ///< [m]
inline constexpr double degree = std::numbers::pi / 180.0;  ///< [rad]
inline constexpr double GPa = 1e9;                          ///< [Pa]

}  // namespace snare::base
