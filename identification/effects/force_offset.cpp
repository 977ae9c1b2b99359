#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// Recorded force without contact.
Parameter offset() {
  return {.key = "reading.force_offset_N",
          .unit = "N",
          .get = [](const PushProblem&, const ReadingModel& r) { return r.force_offset; },
          .set = [](PushProblem&, ReadingModel& r, double v) { r.force_offset = v; },
          .lower = [](const PushProblem&) { return -1e3; },
          .upper = [](const PushProblem&) { return 1e3; },
          .step = 1e-3,
          .derivative = Derivative::force_offset};
}

}  // namespace

/// The recorded force is not zero without contact.
Effect force_offset_effect() {
  Effect e;
  e.name = "force_offset";
  e.channel = Channel::sensor;
  e.meaning = "the load cell does not read zero without load";
  e.numbers = {{offset(), -1e3, 1e3}};
  e.independent_check = "record some readings before the touch";
  return e;
}

}  // namespace snare::identification
