#include "identification/effects/slip_tension.hpp"

namespace snare::identification {

namespace {

/// Force beyond which it slips.
Parameter tension_of_the_right_feed() {
  Parameter p = slip_tension<wire::MountSlip::feeds, wire::SlipPlace::right>();
  p.key = "mount_slip_right.tension_N";
  p.unit = "N";
  return p;
}

std::string told_from_the_left(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.test.pusher.friction > 0.0) return needs_mounts_that_hold(series);
  }
  return "where the wire does not rub on the pusher it slips through either mount at the same force: "
         "mount_slip";
}

}  // namespace

/// The wire feeds through the right mount; another than through the left one only where the wire rubs on the
/// pusher.
Effect mount_slip_right_effect() {
  return {
      .name = "mount_slip_right",
      .channel = Channel::mount,
      .meaning = "the wire slips through the right mount beyond a certain tension",
      .numbers = {{tension_of_the_right_feed(), 1e-3, 1e5}},
      .one_sided = true,
      .trials = trial_slip_tensions,
      .unobservable = told_from_the_left,
      .independent_check = "mark the wire at the mounts and look for a shift of the marks after the test"};
}

}  // namespace snare::identification
