#include "identification/effects/effect.hpp"

namespace snare::identification {

/// The machine behind the pusher gives way like a spring: the pusher travels less than recorded.
Effect pusher_compliance_effect() {
  Effect e;
  e.name = "pusher_compliance";
  e.channel = Channel::pusher;
  e.meaning = "the machine behind the pusher gives way under load";
  e.numbers = {{"pusher.compliance_m_N", 0.0, 1e-4}};
  e.one_sided = true;
  e.independent_check = "push against a stiff block and read the apparent travel";
  return e;
}

}  // namespace snare::identification
