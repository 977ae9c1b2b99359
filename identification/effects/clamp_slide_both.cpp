#include "identification/effects/slip_tension.hpp"

namespace snare::identification {

namespace {

/// Force beyond which it slips.
Parameter force_on_both_clamps() {
  Parameter p = slip_tension<wire::MountSlip::slides, wire::SlipPlace::both>();
  p.key = "clamp_slide_both.tension_N";
  p.unit = "N";
  return p;
}

}  // namespace

/// Either mount slides along the chord, the wire fast in it, each when the force on it passes the same limit.
Effect clamp_slide_both_effect() {
  return {.name = "clamp_slide_both",
          .channel = Channel::mount,
          .meaning = "both mounts slide along the bench beyond a certain force",
          .numbers = {{force_on_both_clamps(), 1e-3, 1e5}},
          .one_sided = true,
          .trials = trial_slip_tensions,
          .unobservable = needs_mounts_that_hold,
          .independent_check = "set dial gauges against the mounts, or scribe lines across mounts and bench"};
}

}  // namespace snare::identification
