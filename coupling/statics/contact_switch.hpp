#pragma once

#include "coupling/statics/push_curve.hpp"
#include "coupling/statics/push_system.hpp"

#include <optional>
#include <vector>

namespace snare::coupling {

/// What the contact did within one step: whether its states changed, and how far into the step the first
/// change came.
class ContactMemory {
 public:
  /// Forgets the step before; to be called at the start of every step.
  void begin() {
    fraction_.reset();
    changed_ = false;
  }
  /// Notes that the contact's states have changed within the step.
  void change() { changed_ = true; }
  /// A change at this fraction of the step, in (0, 1).
  void at_fraction(double fraction) {
    if (!fraction_ || fraction < *fraction_) fraction_ = fraction;
  }
  [[nodiscard]] bool changed() const { return changed_; }
  [[nodiscard]] std::optional<double> event_fraction() const { return fraction_; }

 private:
  std::optional<double> fraction_;
  bool changed_ = false;
};

/// What changed between two contact states, in words.
[[nodiscard]] std::vector<PushEvent::Kind> contact_events(const ContactStates& before,
                                                          const ContactStates& after);

/// Compares a solution with what its contact states assume (force >= 0, gap >= 0, |T| <= mu N, slip against
/// the friction, no vertex inside the pusher) and changes the states that are violated.  theory.md (C.9)
/// Returns true when something changed: the point must be solved again.
[[nodiscard]] bool settle_contact(PushSystem& system, numerics::PathPoint& point, ContactMemory& memory);

/// Stores the accepted point as the one from which slip is measured.
void remember_contact(PushSystem& system, const numerics::PathPoint& point);

}  // namespace snare::coupling
