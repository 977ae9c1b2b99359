#include "identification/effects/mount_compliance.hpp"

namespace snare::identification {

namespace {

/// Of the machine along its motion.
Parameter pusher_compliance() {
  return {.key = "pusher.compliance_m_N",
          .unit = "m/N",
          .number = member([](auto& p, auto&) -> auto& { return p.pusher.compliance; }),
          .limits = [](const PushProblem&) { return between(0.0, 1e-3); },
          .step = 1e-10};
}

}  // namespace

/// The machine behind the pusher gives way like a spring: the pusher travels less than recorded.
Effect pusher_compliance_effect() {
  return {.name = "pusher_compliance",
          .channel = Channel::pusher,
          .meaning = "the machine behind the pusher gives way under load",
          .numbers = {{pusher_compliance(), 0.0, 1e-4}},
          .one_sided = true,
          .sizes = sizes_beside_stretching,
          .independent_check = "push against a stiff block and read the apparent travel"};
}

}  // namespace snare::identification
