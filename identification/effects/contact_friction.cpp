#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// Coulomb's coefficient between wire and pusher.
Parameter coefficient() {
  return {.key = "pusher.friction",
          .number = member([](auto& p, auto&) -> auto& { return p.pusher.friction; }),
          .limits = [](const PushProblem&) { return between(0.0, 2.0); },
          .step = 1e-5};
}

// Sticking has no derivative at zero friction: the contact sticks over a travel that grows with it.
std::vector<std::vector<double>> trial_coefficients(const TrialContext&) {
  return {{0.03}, {0.1}, {0.25}};
}

}  // namespace

/// Coulomb friction between wire and pusher (on supports: between wire and supports).
Effect contact_friction_effect() {
  return {.name = "contact_friction",
          .channel = Channel::contact,
          .meaning = "the wire rubs on the pusher",
          .numbers = {{coefficient(), 0.0, 1.0}},
          .one_sided = true,
          .trials = trial_coefficients,
          .independent_check = "load and unload with a lubricated and with a dry pusher"};
}

}  // namespace snare::identification
