#include "identification/effect.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

std::vector<std::vector<double>> trial_stresses(const TrialContext& context) {
  const wire::WireSpecification& wire = context.model->series().front().test.wire;
  const double highest = wire.youngs_modulus * std::max(0.5 * wire.diameter * context.highest_curvature,
                                                        context.highest_tension / context.axial_stiffness);
  std::vector<std::vector<double>> result;
  for (const double share : {0.3, 0.5, 0.7, 0.85, 0.95}) result.push_back({std::log(share * highest)});
  return result;
}

}  // namespace

/// The metal yields, in bending from the outer fibres inwards and in tension.
Effect plasticity_effect() {
  Effect e;
  e.name = "plasticity";
  e.channel = Channel::wire;
  e.meaning = "the metal of the wire yields";
  e.numbers = {{"plasticity.yield_stress_MPa", 20.0, 4000.0}};
  e.one_sided = true;
  e.trials = trial_stresses;
  e.independent_check = "look for a lasting kink or elongation of the wire after the test";
  return e;
}

}  // namespace snare::identification
