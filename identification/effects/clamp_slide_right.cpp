#include "identification/effects/slip_tension.hpp"

namespace snare::identification {

namespace {

/// Force beyond which it slips.
Parameter force_on_the_right_clamp() {
  Parameter p = slip_tension<wire::MountSlip::slides, wire::SlipPlace::right>();
  p.key = "clamp_slide_right.tension_N";
  p.unit = "N";
  return p;
}

}  // namespace

/// The right mount slides along the chord, the wire fast in it, when the force along the chord passes a
/// limit.
Effect clamp_slide_right_effect() {
  return {.name = "clamp_slide_right",
          .channel = Channel::mount,
          .meaning = "the right mount slides along the bench beyond a certain force",
          .numbers = {{force_on_the_right_clamp(), 1e-3, 1e5}},
          .one_sided = true,
          .trials = trial_slip_tensions,
          .unobservable = needs_mounts_that_hold,
          .independent_check = "set a dial gauge against the mount, or scribe a line across mount and bench"};
}

}  // namespace snare::identification
