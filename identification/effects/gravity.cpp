#include "identification/effects/effect.hpp"

namespace snare::identification {

/// Weight along the bulge: the wire does not hang as declared.
Effect gravity_effect() {
  Effect e;
  e.name = "gravity";
  e.channel = Channel::geometry;
  e.meaning = "the wire's weight acts along the bulge";
  e.numbers = {{"gravity.along_bulge_m_s2", -9.9, 9.9}};
  e.independent_check = "turn the bench over and repeat";
  return e;
}

}  // namespace snare::identification
