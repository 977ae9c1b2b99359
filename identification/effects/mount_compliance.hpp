#pragma once

#include "identification/effects/effect.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace snare::identification {

/// For Effect::unobservable: only clamps hold the wire's direction, and sections that slip or yield need
/// stiff ones.
[[nodiscard]] std::string needs_clamps(const std::vector<Series>& series);

/// For Effect::sizes: compliances of clamps as shares of that of the wire in bending, length / EI [rad/(N
/// m)].
[[nodiscard]] std::vector<double> sizes_beside_bending(const PushProblem& declared);
/// For Effect::sizes: compliances along the chord as multiples of that of the wire, length / EA [m/N].
[[nodiscard]] std::vector<double> sizes_beside_stretching(const PushProblem& declared);

/// For Parameter::limits: up to a hundred times length / EI, where a clamp hardly differs from a pin [rad/(N
/// m)].
[[nodiscard]] Limits limits_in_rotation(const PushProblem& declared);
/// For Parameter::limits: up to a thousand times length / EA [m/N].
[[nodiscard]] Limits limits_along_chord(const PushProblem& declared);

/// Compliance along the chord of the left (0) or the right (1) mount by itself, in series with that of both
/// mounts [m/N].
template <std::size_t mount>
[[nodiscard]] Parameter axial_compliance_of() {
  return {
      .number = member([](auto& p, auto&) -> auto& { return p.mount.own_translational_compliance[mount]; }),
      .limits = limits_along_chord,
      .step = 1e-12,
      .mounts_give = [](const PushProblem& p) {
        std::array<double, 2> result{};
        result[mount] = std::isinf(p.mount.translational_stiffness_of(mount)) ? 1.0 : 0.0;
        return result;
      }};
}

/// Compliance in rotation of its clamp [rad/(N m)].
template <std::size_t mount>
[[nodiscard]] Parameter rotational_compliance_of() {
  return {.number = member([](auto& p, auto&) -> auto& { return p.mount.own_rotational_compliance[mount]; }),
          .limits = limits_in_rotation,
          .step = 1e-6};
}

}  // namespace snare::identification
