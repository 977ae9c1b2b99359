#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

Parameter drift() {
  return {.key = "force_drift.rate_N_s",
          .unit = "N/s",
          .number = member([](auto&, auto& r) -> auto& { return r.drift; }),
          .limits = [](const PushProblem&) { return between(-10.0, 10.0); },
          .step = 1e-6,
          .derivative = Derivative::record};
}

}  // namespace

/// The recorded force drifts with time, whatever the wire does.
Effect force_drift_effect() {
  return {
      .name = "force_drift",
      .channel = Channel::sensor,
      .meaning = "the reading of the load cell drifts with time",
      .numbers = {{drift(), -10.0, 10.0}},
      .unobservable = needs_times,
      .independent_check = "record the load cell without touching the wire, for as long as a series takes"};
}

}  // namespace snare::identification
