#include "coupling/dynamics/model/strength.hpp"

#include "wire/motion/rod_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::coupling {

using numerics::DaePoint;

WireStrength wire_strength(const wire::WireSpecification& wire, double breaking_tension, bool ends_run) {
  const double d = wire.diameter;
  const bool solid = wire.construction == wire::Construction::solid;
  return {breaking_tension, solid ? wire.youngs_modulus * std::numbers::pi * d * d * d / 8.0 : 0.0, ends_run};
}

// At a vertex the larger of the tensions beside it.
StrengthUse strength_use(const WireStrength& strength, wire::RodPart& rod, const DaePoint& at) {
  const wire::RodModel& model = rod.model();
  const auto [tensions, moments] = rod.section_loads(at);
  StrengthUse largest;
  largest.time = at.time;
  for (int i = 0; i < rod.vertices(); ++i) {
    const double tension = std::max(tensions[std::max(i - 1, 0)], tensions[std::min(i, model.edges() - 1)]);
    const double bending = strength.bending_force * moments[i] / model.properties().bending_stiffness;
    const double share = (tension + bending) / strength.breaking_tension;
    if (share > largest.share) largest = {share, tension, bending, rod.coordinate(i), at.time};
  }
  return largest;
}

std::string strength_reached(const WireStrength& strength, const StrengthUse& use) {
  return fmt::format(
      " reaches its strength of {:.6g} N at {:.9g} s, {:.6g} m along it: tension {:.6g} N, bending as much "
      "as {:.6g} N",
      strength.breaking_tension, use.time, use.arc, use.tension, use.bending);
}

std::optional<std::string> watch_strength(const WireStrength& strength, wire::RodPart& rod,
                                          const DaePoint& at, StrengthUse& largest) {
  if (!std::isfinite(strength.breaking_tension)) return std::nullopt;
  const StrengthUse use = strength_use(strength, rod, at);
  if (use.share > largest.share) largest = use;
  if (use.share < 1.0 || !strength.ends_run) return std::nullopt;
  return strength_reached(strength, use);
}

}  // namespace snare::coupling
