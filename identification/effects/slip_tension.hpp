#pragma once

#include "identification/effects/effect.hpp"

#include <limits>
#include <string>
#include <vector>

namespace snare::identification {

/// The force beyond which a mount slips in this way and place, as a number that has no key yet: infinite
/// where it does not.
template <wire::MountSlip slip, wire::SlipPlace place>
[[nodiscard]] Parameter slip_tension() {
  return {.parametrisation = Parametrisation::magnitude,
          .number = {[](const PushProblem& p, const ReadingModel&) {
                       return p.mount.slip == slip && p.mount.slip_at == place
                                  ? p.mount.slip_tension.value_or(std::numeric_limits<double>::infinity())
                                  : std::numeric_limits<double>::infinity();
                     },
                     [](PushProblem& p, ReadingModel&, double v) {
                       p.mount.slip_tension = v;
                       p.mount.slip = slip;
                       p.mount.slip_at = place;
                     }},
          .limits =
              [](const PushProblem& p) {
                return between(1e-9 * p.wire.axial_stiffness(), p.wire.axial_stiffness());
              },
          .step = 1e-4};
}

/// Forces at which a mount may begin to slip, as coordinates, logarithms [-] of newtons: from just above what
/// the buckled wire pushes, which the mount must have held, to the highest tension of the test.
[[nodiscard]] std::vector<std::vector<double>> trial_slip_tensions(const TrialContext& context);

/// For Effect::unobservable: the wire is held by mounts, none of which slips already.
[[nodiscard]] std::string needs_mounts_that_hold(const std::vector<Series>& series);

}  // namespace snare::identification
