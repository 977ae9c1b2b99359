#pragma once

#include "coupling/dynamics/model/result.hpp"
#include "numerics/dae.hpp"

#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace snare::coupling {

/// Takes the sample of a stretch or of a piece into that of all: sums of forces; gap and place of what
/// presses most.
void take_in(const ContactSample& one, ContactSample& sum);

/// The same sample with a force and a normal force [N] from elsewhere, shared by its points as theirs were.
[[nodiscard]] ContactSample with_force(ContactSample sample, const Eigen::Vector3d& force, double normal);

/// The stretches in contact, followed from state to state.
class ContactTouches {
 public:
  /// Gap [m] and its rate [m/s] at a material coordinate of the wire [m] in a state.
  using GapAt = std::function<std::pair<double, double>(const numerics::VectorView& y, double coordinate)>;
  /// A state at a time [s].
  struct Seen {
    double time = 0.0;
    numerics::VectorView y;
  };

  /// reach: stretches that have moved by no more are the same [m]. sticks: whether stick and slip are told.
  ContactTouches(double reach, bool sticks) : reach_(reach), sticks_(sticks) {}

  /// What has happened since the last state told: `contact` of the events is left at 0. The sample is that of
  /// `now`.
  [[nodiscard]] std::vector<MotionEvent> observe(const ContactSample& sample, const Seen& now,
                                                 const Seen& before, const GapAt& gap_at);
  /// How many of the states told last have touched without a break.
  [[nodiscard]] int held_states() const { return held_states_; }
  /// What is known of the last state: see DaePart. Material coordinates [m] and what sticks.
  void save_state(std::vector<double>& memory) const;
  void restore_state(std::span<const double>& memory);

 private:
  struct Touching {
    double arc = 0.0;  // [m]
    int point = 0;
    bool sticking = false;
  };
  [[nodiscard]] int free_point() const;

  double reach_;
  bool sticks_;
  std::vector<Touching> touching_;
  int held_states_ = 0;
};

}  // namespace snare::coupling
