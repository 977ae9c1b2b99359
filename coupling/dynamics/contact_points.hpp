#pragma once

#include "coupling/dynamics/contact_part.hpp"
#include "coupling/dynamics/contact_search.hpp"

#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace snare::coupling {

/// All points at which one shape touches one wire: as many as `MotionContact::points` at a time, each at its own local minimum
/// of the gap.                                                                      theory.md (G.7)
class ContactPoints {
 public:
  ContactPoints(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body,
                const MotionOptions& options);

  [[nodiscard]] std::deque<ContactPart>& points() { return points_; }
  [[nodiscard]] const std::deque<ContactPart>& points() const { return points_; }
  [[nodiscard]] const MotionContact& contact() const { return contact_; }

  /// A point that is open, or nothing.
  [[nodiscard]] std::optional<std::size_t> free_point() const;
  /// Opens a point; it touches again when it comes back from where it stands. Returns the energy that its bristle held [J].
  [[nodiscard]] double open(std::size_t point, Eigen::VectorXd& y);
  /// What stands at this gap is open, and touches only when it is deeper [m].
  void leave_apart(double gap);
  /// What is known beside the points' own states: see DaePart.
  void save_state(std::vector<double>& memory) const;
  void restore_state(std::span<const double>& memory);

  /// See ContactSearch: the minima at which no point is closed.
  [[nodiscard]] std::optional<double> first_touch(const ContactSearch::Step& step, double until);
  [[nodiscard]] std::vector<GapMinimum> touching(const numerics::VectorView& y) const;
  void forget() { search_.forget(); }
  [[nodiscard]] GapMinimum nearest(const numerics::VectorView& y) const { return search_.nearest(y); }

  /// Sums over the closed points; gap and place are those of the point that presses most, or of the nearest open one.
  [[nodiscard]] ContactSample sample(const numerics::DaePoint& at) const;
  /// The same of closed points alone: without a search.
  [[nodiscard]] ContactSample closed_sample(const numerics::DaePoint& at) const;

 private:
  [[nodiscard]] std::vector<ContactSearch::Held> held() const;

  MotionContact contact_;
  const wire::RodPart& rod_;
  std::deque<ContactPart> points_;
  ContactSearch search_;
  double together_ = 0.0;  // gap up to which points touch at the same time [m]
  double touch_;           // gap at which an open point touches [m], < 0
};

}  // namespace snare::coupling
