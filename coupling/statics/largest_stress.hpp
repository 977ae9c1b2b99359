#pragma once

#include "coupling/statics/push_solver.hpp"
#include "wire/physical_range.hpp"

#include <algorithm>
#include <vector>

namespace snare::coupling {

/// Largest stress in a wire over the points of a push, by its largest tension and its largest bending moment
/// [Pa].
///                                                                                           theory.md (W.35)
[[nodiscard]] inline double largest_stress(const wire::WireSpecification& wire,
                                           const std::vector<PushPoint>& points) {
  double stress = 0.0;
  for (const PushPoint& p : points)
    stress = std::max(stress, wire::largest_stress(wire, p.largest_tension, p.bending_moment));
  return stress;
}

}  // namespace snare::coupling
