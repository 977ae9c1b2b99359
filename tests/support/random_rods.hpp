#pragma once

#include "wire/planar_rod.hpp"
#include "wire/spatial_rod.hpp"

#include <random>

namespace snare::test {

/// Length-one rods with stiffnesses of order one, so that every entry of a derivative is of comparable size.
[[nodiscard]] wire::PlanarRodProperties planar_properties();
[[nodiscard]] wire::SpatialRodProperties round_properties();

/// Bends and stretches differently in every direction, naturally curved and twisted, mounts that give.
[[nodiscard]] wire::SpatialRodProperties general_properties();

/// A crooked rod: unit spacing disturbed by up to `amount` edge lengths in every direction, angles by up to
/// one.
[[nodiscard]] wire::PlanarState random_state(const wire::PlanarRod& rod, const wire::Controls& controls,
                                             std::mt19937& random, double amount);
[[nodiscard]] wire::SpatialState random_state(const wire::SpatialRod& rod, const wire::Controls& controls,
                                              std::mt19937& random, double amount);

}  // namespace snare::test
