#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// EA.
Parameter axial_stiffness() {
  return {.key = "wire.axial_stiffness_N",
          .unit = "N",
          .parametrisation = Parametrisation::ratio,
          .number = {[](const PushProblem& p, const ReadingModel&) { return p.wire.axial_stiffness(); },
                     [](PushProblem& p, ReadingModel&, double v) { p.wire.axial_stiffness_override = v; }},
          .limits =
              [](const PushProblem& p) {
                return between(1e-3 * p.wire.axial_stiffness(), 5.0 * p.wire.axial_stiffness());
              },
          .step = 1e-3};
}

}  // namespace

/// The axial stiffness is not that of the declared section: a strand, another diameter or modulus.
Effect axial_stiffness_effect() {
  return {
      .name = "axial_stiffness",
      .channel = Channel::wire,
      .meaning = "the wire's axial stiffness is not as declared",
      .numbers = {{axial_stiffness(), 1e3, 1e8}},
      .independent_check = "pull a piece of the wire in a tensile machine with an extensometer on the wire"};
}

}  // namespace snare::identification
