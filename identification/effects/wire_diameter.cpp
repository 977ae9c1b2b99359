#include "identification/effects/effect.hpp"

#include "base/units.hpp"

namespace snare::identification {

namespace {

const char* diameter_unseen(const PushProblem& p) {
  const bool touches = p.pusher.radius > 0.0 || p.mount.kind == wire::MountKind::supports;
  return stiffnesses_declared(p) && weightless(p) && !touches
             ? "both stiffnesses are declared, the wire has no weight, and its centreline meets a knife edge"
             : "";
}

Parameter section_diameter() {
  return {
      .key = "wire.diameter_mm",
      .unit = "mm",
      .unit_size = base::mm,
      .number = member([](auto& p, auto&) -> auto& { return p.wire.diameter; }),
      .limits = [](const PushProblem& p) { return between(0.5 * p.wire.diameter, 1.5 * p.wire.diameter); },
      .step = 1e-8,
      .unseen = diameter_unseen};
}

std::string needs_a_section(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (!stiffnesses_declared(s.test)) return "";
  }
  return "both stiffnesses are declared or fitted: they do not follow from the diameter";
}

}  // namespace

/// The wire is thicker or thinner than declared: both stiffnesses, which follow from the section, change
/// together.
Effect wire_diameter_effect() {
  return {.name = "wire_diameter",
          .channel = Channel::wire,
          .meaning = "the wire is thicker or thinner than declared",
          .numbers = {{section_diameter(), 1e-3, 1e3}},
          .unobservable = needs_a_section,
          .independent_check = "measure the wire with a micrometer at several places"};
}

}  // namespace snare::identification
