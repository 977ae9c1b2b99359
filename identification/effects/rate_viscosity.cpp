#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

std::string needs_times(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.readings && !s.readings->time.empty()) return "";
  }
  return "the record has no times";
}

}  // namespace

/// The wire resists the rate of its deformation (Kelvin-Voigt), to first order in the relaxation time.
Effect rate_viscosity_effect() {
  Effect e;
  e.name = "rate_viscosity";
  e.channel = Channel::wire;
  e.meaning = "the wire resists the rate at which it is deformed";
  e.numbers = {{"rate_viscosity.relaxation_time_s", 0.0, 1e3}};
  e.one_sided = true;
  e.unobservable = needs_times;
  e.independent_check = "push at a tenth and at ten times the speed";
  return e;
}

}  // namespace snare::identification
