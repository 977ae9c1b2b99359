#pragma once

#include <array>

namespace snare::coupling {

// How a load is integrated along a closed stretch of a wire: the same for contact with bodies and with other wires.
//                                                                                        theory.md (M.8), (M.9)

/// Gauss's rule on a closed stretch: exact for a parabola of load under the cubics of the curve.
inline constexpr std::array<double, 3> gauss_places{0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417};
inline constexpr std::array<double, 3> gauss_weights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

/// A slider slower than this stands still [m/s].
inline constexpr double standing = 1e-5;

}  // namespace snare::coupling
