#include "identification/effects/effect.hpp"

#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

/// Tension at which the mount lets the wire through.
Parameter tension() {
  return {
      .key = "mount_slip.tension_N",
      .unit = "N",
      .parametrisation = Parametrisation::magnitude,
      .number = {[](const PushProblem& p, const ReadingModel&) {
                   return p.mount.slip_tension.value_or(std::numeric_limits<double>::infinity());
                 },
                 [](PushProblem& p, ReadingModel&, double v) { p.mount.slip_tension = v; }},
      .limits = [](const PushProblem& p) { return between(1e-9 * p.wire.axial_stiffness(), p.wire.axial_stiffness()); },
      .step = 1e-4};
}

// The tension at which slip begins decides everything: from just above what the buckled wire pushes, which
// the mount must have held, to the highest tension of the test.
std::vector<std::vector<double>> trial_tensions(const TrialContext& context) {
  std::vector<std::vector<double>> result;
  for (const double share : {0.15, 0.3, 0.45, 0.6, 0.75, 0.9}) {
    const double tension = share * context.highest_tension;
    if (tension > 1.02 * context.highest_compression) result.push_back({std::log(tension)});
  }
  return result;
}

}  // namespace

/// The wire feeds through the left mount by Coulomb's law when its tension passes a limit.
Effect mount_slip_effect() {
  return {.name = "mount_slip",
          .channel = Channel::mount,
          .meaning = "the wire slips through a mount beyond a certain tension",
          .numbers = {{tension(), 1e-3, 1e5}},
          .one_sided = true,
          .trials = trial_tensions,
          .unobservable = needs_mounts,
          .independent_check = "mark the wire at the mounts and look for a shift of the marks after the test"};
}

}  // namespace snare::identification
