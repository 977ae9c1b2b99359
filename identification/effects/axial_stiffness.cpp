#include "identification/effects/effect.hpp"

namespace snare::identification {

/// The axial stiffness is not that of the declared section: a strand, another diameter or modulus.
Effect axial_stiffness_effect() {
  Effect e;
  e.name = "axial_stiffness";
  e.channel = Channel::wire;
  e.meaning = "the wire's axial stiffness is not as declared";
  e.numbers = {{"wire.axial_stiffness_N", 1e3, 1e8}};
  e.independent_check = "pull a piece of the wire in a tensile machine with an extensometer on the wire";
  return e;
}

}  // namespace snare::identification
