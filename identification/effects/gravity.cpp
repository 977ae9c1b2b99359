#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// Acceleration along the bulge.
Parameter along_bulge() {
  return {.key = "gravity.along_bulge_m_s2",
          .unit = "m/s^2",
          .get = [](const PushProblem& p, const ReadingModel&) { return p.gravity[1]; },
          .set = [](PushProblem& p, ReadingModel&, double v) { p.gravity[1] = v; },
          .lower = [](const PushProblem&) { return -100.0; },
          .upper = [](const PushProblem&) { return 100.0; },
          .step = 1e-2};
}

}  // namespace

/// Weight along the bulge: the wire does not hang as declared.
Effect gravity_effect() {
  Effect e;
  e.name = "gravity";
  e.channel = Channel::geometry;
  e.meaning = "the wire's weight acts along the bulge";
  e.numbers = {{along_bulge(), -9.9, 9.9}};
  e.independent_check = "turn the bench over and repeat";
  return e;
}

}  // namespace snare::identification
