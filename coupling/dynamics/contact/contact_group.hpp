#pragma once

#include "coupling/dynamics/contact/contact_part.hpp"
#include "coupling/dynamics/contact/contact_touches.hpp"
#include "coupling/dynamics/contact/interaction.hpp"

#include <deque>
#include <span>
#include <utility>
#include <vector>

namespace snare::coupling {

/// A shape on a wire: its convex pieces, and what happens where they touch.
class ContactGroup final : public Interaction {
 public:
  ContactGroup(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body);

  /// Convex pieces of the shape, each of which touches the wire by itself.
  [[nodiscard]] std::deque<ContactPart>& pieces() { return pieces_; }
  [[nodiscard]] const std::deque<ContactPart>& pieces() const { return pieces_; }

  /// Of all pieces, at unknowns y of the run (SI units).
  [[nodiscard]] ContactPart::Sums sums(const numerics::VectorView& y) const;

  void append(std::vector<numerics::DaePart*>& parts) override;
  [[nodiscard]] std::optional<base::InputProblem> overlap(const numerics::VectorView& y,
                                                          double tolerance) const override;
  void update_candidates(const numerics::VectorView& y) override;
  void set_bristle_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const override;
  [[nodiscard]] std::vector<int> restrict_to_plane(int normal) override;
  void leave_plane() override;
  [[nodiscard]] double longest_step() const override;
  [[nodiscard]] double energy(const numerics::DaePoint& at) const override { return sums(at.y).energy; }
  void add_rates(const numerics::DaePoint& at, const IntegralRates& rates) const override;
  [[nodiscard]] Load load(const numerics::DaePoint& at) const override;
  /// The place on the wire nearest to any piece [m].
  [[nodiscard]] NearestPoint nearest(const numerics::VectorView& y) const;
  /// Sums over what is closed; gap and place are those of the stretch that presses most, or of the nearest
  /// point. y in SI units.
  [[nodiscard]] ContactSample sample(const numerics::DaePoint& at) const override;
  [[nodiscard]] std::optional<int> held_states() const override { return touches_.held_states(); }
  void take_from_mounts(const numerics::VectorView& y,
                        std::vector<Eigen::Vector3d>& mount_forces) const override;
  [[nodiscard]] Observed observe(const numerics::DaePoint& now, double time_before,
                                 const Eigen::VectorXd& before) override;
  [[nodiscard]] bool is_law() const override { return pieces_.front().has_law(); }
  [[nodiscard]] bool has_event() const override { return false; }
  void save_touches(std::vector<double>& memory) const override { touches_.save_state(memory); }
  void restore_touches(std::span<const double>& memory) override { touches_.restore_state(memory); }

 private:
  /// Of closed stretches alone: without a search. y in SI units.
  [[nodiscard]] ContactSample closed_sample(const numerics::VectorView& y) const;
  /// Gap and its rate at a material coordinate, of the nearest piece.
  [[nodiscard]] std::pair<double, double> gap_at(const numerics::VectorView& y, double coordinate) const;

  MotionContact contact_;
  const wire::RodPart& rod_;
  const BodyPart& body_;
  std::deque<ContactPart> pieces_;
  ContactTouches touches_{0.0, false};
};

}  // namespace snare::coupling
