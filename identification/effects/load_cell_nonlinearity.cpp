#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

Parameter force_bow() {
  return {.key = "load_cell_nonlinearity.at_half_range",
          .number = member([](auto&, auto& r) -> auto& { return r.force_bow; }),
          .limits = [](const PushProblem&) { return between(-0.2, 0.2); },
          .step = 1e-4,
          .derivative = Derivative::record};
}

}  // namespace

/// The load cell is not linear: it deviates at half of the largest force, not at its ends.
Effect load_cell_nonlinearity_effect() {
  return {.name = "load_cell_nonlinearity",
          .channel = Channel::sensor,
          .meaning = "the load cell is not linear",
          .numbers = {{force_bow(), -0.1, 0.1}},
          .unobservable = needs_readings,
          .independent_check = "hang known weights on the load cell, at least five over its range"};
}

}  // namespace snare::identification
