#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// EI, from that of a rope of free hairs to more than twice the solid section.
Parameter bending_stiffness() {
  return {.key = "wire.bending_stiffness_Nm2",
          .unit = "N m^2",
          .parametrisation = Parametrisation::ratio,
          .number = {[](const PushProblem& p, const ReadingModel&) { return p.wire.bending_stiffness(); },
                     [](PushProblem& p, ReadingModel&, double v) { p.wire.bending_stiffness_override = v; }},
          .limits =
              [](const PushProblem& p) {
                return between(1e-4 * p.wire.bending_stiffness(), 5.0 * p.wire.bending_stiffness());
              },
          .step = 1e-3};
}

}  // namespace

/// The bending stiffness is not that of the declared section: a strand, another diameter or modulus.
Effect bending_stiffness_effect() {
  return {
      .name = "bending_stiffness",
      .channel = Channel::wire,
      .meaning = "the wire's bending stiffness is not as declared",
      .numbers = {{bending_stiffness(), 1e-7, 10.0}},
      .independent_check = "bend a straight piece of the wire between two supports and read its stiffness"};
}

}  // namespace snare::identification
