#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// tau of N = EA (e + tau de/dt), in bending alike.
Parameter relaxation_time() {
  return {.key = "rate_viscosity.relaxation_time_s",
          .unit = "s",
          .number = member([](auto&, auto& r) -> auto& { return r.relaxation_time; }),
          .limits = [](const PushProblem&) { return between(0.0, 1e6); },
          .step = 1e-6,
          .derivative = Derivative::rate};
}

}  // namespace

/// The wire resists the rate of its deformation (Kelvin-Voigt), to first order in the relaxation time.
Effect rate_viscosity_effect() {
  return {.name = "rate_viscosity",
          .channel = Channel::wire,
          .meaning = "the wire resists the rate at which it is deformed",
          .numbers = {{relaxation_time(), 0.0, 1e3}},
          .one_sided = true,
          .unobservable = needs_times,
          .independent_check = "push at a tenth and at ten times the speed"};
}

}  // namespace snare::identification
