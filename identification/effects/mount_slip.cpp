#include "identification/effects/slip_tension.hpp"

namespace snare::identification {

namespace {

/// Force beyond which it slips.
Parameter tension_of_the_feed() {
  Parameter p = slip_tension<wire::MountSlip::feeds, wire::SlipPlace::left>();
  p.key = "mount_slip.tension_N";
  p.unit = "N";
  return p;
}

}  // namespace

/// The wire feeds through the left mount by Coulomb's law when its tension passes a limit. Without friction
/// at the pusher the driving force is the same all along the wire, so that it stands for the right mount and
/// for both: theory.md (C.8).
Effect mount_slip_effect() {
  return {
      .name = "mount_slip",
      .channel = Channel::mount,
      .meaning = "the wire slips through a mount beyond a certain tension",
      .numbers = {{tension_of_the_feed(), 1e-3, 1e5}},
      .one_sided = true,
      .trials = trial_slip_tensions,
      .unobservable = needs_mounts_that_hold,
      .independent_check = "mark the wire at the mounts and look for a shift of the marks after the test"};
}

}  // namespace snare::identification
