#include "identification/effects/effect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace snare::identification {

namespace {

/// Yield stresses of metals that wires are drawn from [MPa]: annealed copper 33, aluminium 1100-O 34 (ASM
/// Handbook, vol. 2, 1990), lower than all steels; the tensile strength of the thinnest music wire is below
/// 4000 (ASTM A228).
constexpr double softest = 30.0;
constexpr double hardest = 4000.0;

/// At which the outer fibres begin to yield.
Parameter yield_stress() {
  return {.key = "plasticity.yield_stress_MPa",
          .unit = "MPa",
          .unit_size = 1e6,
          .parametrisation = Parametrisation::magnitude,
          .number = {[](const PushProblem& p, const ReadingModel&) {
                       return p.wire.yielding ? p.wire.yielding->yield_stress
                                              : std::numeric_limits<double>::infinity();
                     },
                     [](PushProblem& p, ReadingModel&, double v) {
                       if (!p.wire.yielding) p.wire.yielding = wire::Yielding{};
                       p.wire.yielding->yield_stress = v;
                     }},
          .limits = [](const PushProblem& p) { return between(1e6, 0.5 * p.wire.youngs_modulus); },
          .step = 1e-3};
}

/// Tangent modulus over E once the metal yields.
Parameter hardening_ratio() {
  return {.key = "plasticity.hardening_ratio",
          .number = {[](const PushProblem& p, const ReadingModel&) {
                       return p.wire.yielding ? p.wire.yielding->hardening_ratio
                                              : wire::Yielding::usual_hardening;
                     },
                     [](PushProblem& p, ReadingModel&, double v) {
                       if (p.wire.yielding) p.wire.yielding->hardening_ratio = v;
                     }},
          .limits = [](const PushProblem&) { return between(0.002, 0.9); },
          .step = 1e-5};
}

std::vector<std::vector<double>> trial_stresses(const TrialContext& context) {
  const wire::WireSpecification& wire = context.model->series().front().test.wire;
  const double area = 0.25 * std::numbers::pi * wire.diameter * wire.diameter;
  const double bending = context.bending_stiffness * context.highest_curvature * 8.0 / (area * wire.diameter);
  const double highest = std::max(bending, context.highest_tension / area);
  std::vector<std::vector<double>> result;
  // With the usual hardening, and with one as of a section that yields in part.
  for (const double share : {0.3, 0.5, 0.7, 0.85, 0.95}) result.push_back({std::log(share * highest), 0.0});
  for (const double share : {0.03, 0.1, 0.3}) result.push_back({std::log(share * highest), 0.2});
  return result;
}

}  // namespace

/// The metal yields, in bending from the outer fibres inwards and in tension.
Effect plasticity_effect() {
  return {.name = "plasticity",
          .channel = Channel::wire,
          .meaning = "the metal of the wire yields",
          .numbers = {{yield_stress(), softest, hardest}, {hardening_ratio(), 0.0, 0.5, true}},
          .one_sided = true,
          .trials = trial_stresses,
          .independent_check = "look for a lasting kink or elongation of the wire after the test"};
}

}  // namespace snare::identification
