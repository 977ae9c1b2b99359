#include "identification/effects/slip_tension.hpp"

namespace snare::identification {

/// The left mount slides along the chord, the wire fast in it, when the force along the chord passes a limit.
Effect clamp_slide_effect() {
  return {.name = "clamp_slide",
          .channel = Channel::mount,
          .meaning = "the left mount slides along the bench beyond a certain force",
          .numbers = {{slip_tension<wire::MountSlip::slides, wire::SlipPlace::left>("clamp_slide.tension_N"), 1e-3, 1e5}},
          .one_sided = true,
          .trials = trial_slip_tensions,
          .unobservable = needs_mounts_that_hold,
          .independent_check = "set a dial gauge against the mount, or scribe a line across mount and bench"};
}

}  // namespace snare::identification
