#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// EA.
Parameter axial_stiffness() {
  return {.key = "wire.axial_stiffness_N",
          .unit = "N",
          .parametrisation = Parametrisation::ratio,
          .get = [](const PushProblem& p, const ReadingModel&) { return p.wire.axial_stiffness(); },
          .set = [](PushProblem& p, ReadingModel&, double v) { p.wire.axial_stiffness_override = v; },
          .lower = [](const PushProblem& p) { return 1e-3 * p.wire.axial_stiffness(); },
          .upper = [](const PushProblem& p) { return 5.0 * p.wire.axial_stiffness(); },
          .step = 1e-3};
}

}  // namespace

/// The axial stiffness is not that of the declared section: a strand, another diameter or modulus.
Effect axial_stiffness_effect() {
  Effect e;
  e.name = "axial_stiffness";
  e.channel = Channel::wire;
  e.meaning = "the wire's axial stiffness is not as declared";
  e.numbers = {{axial_stiffness(), 1e3, 1e8}};
  e.independent_check = "pull a piece of the wire in a tensile machine with an extensometer on the wire";
  return e;
}

}  // namespace snare::identification
