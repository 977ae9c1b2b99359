#pragma once

#include "coupling/dynamics/contact/contact_part.hpp"
#include "coupling/dynamics/contact/contact_touches.hpp"

#include <deque>
#include <span>
#include <utility>
#include <vector>

namespace snare::coupling {

/// A shape on a wire: its convex pieces, and what happens where they touch.
class ContactGroup {
 public:
  ContactGroup(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body);

  /// Convex pieces of the shape, each of which touches the wire by itself.
  [[nodiscard]] std::deque<ContactPart>& pieces() { return pieces_; }
  [[nodiscard]] const std::deque<ContactPart>& pieces() const { return pieces_; }

  /// Of all pieces, at unknowns y of the run (SI units).
  [[nodiscard]] ContactPart::Sums sums(const numerics::VectorView& y) const;
  /// The shortest of the pieces' longest steps [s]: see ContactSearch.
  [[nodiscard]] double longest_step() const;
  /// The place on the wire nearest to any piece [m].
  [[nodiscard]] NearestPoint nearest(const numerics::VectorView& y) const;
  /// Sums over what is closed; gap and place are those of the stretch that presses most, or of the nearest point. y in SI units.
  [[nodiscard]] ContactSample sample(const numerics::VectorView& y) const;
  [[nodiscard]] const ContactTouches& touches() const { return touches_; }
  /// The same of closed stretches alone: without a search. y in SI units.
  [[nodiscard]] ContactSample closed_sample(const numerics::VectorView& y) const;

  /// What has happened since the last state told: `contact` of the events is left at 0. The sample is that of y at `time` [s], `before`
  /// an earlier state.
  [[nodiscard]] std::vector<MotionEvent> observe(double time, const ContactSample& sample,
                                                 const numerics::VectorView& y, double time_before,
                                                 const numerics::VectorView& before);
  /// What is known of the last state beside the unknowns: see DaePart. Times [s] and places [m].
  void save_state(std::vector<double>& memory) const { touches_.save_state(memory); }
  void restore_state(std::span<const double>& memory) { touches_.restore_state(memory); }

 private:
  /// Gap and its rate at a material coordinate, of the nearest piece.
  [[nodiscard]] std::pair<double, double> gap_at(const numerics::VectorView& y, double coordinate) const;

  const wire::RodPart& rod_;
  std::deque<ContactPart> pieces_;
  ContactTouches touches_{0.0, false};
};

}  // namespace snare::coupling
