#include "identification/effects/effect.hpp"

namespace snare::identification {

/// The bending stiffness is not that of the declared section: a strand, another diameter or modulus.
Effect bending_stiffness_effect() {
  Effect e;
  e.name = "bending_stiffness";
  e.channel = Channel::wire;
  e.meaning = "the wire's bending stiffness is not as declared";
  e.numbers = {{"wire.bending_stiffness_Nm2", 1e-7, 10.0}};
  e.independent_check = "bend a straight piece of the wire between two supports and read its stiffness";
  return e;
}

}  // namespace snare::identification
