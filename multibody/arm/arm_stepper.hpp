#pragma once

#include "multibody/arm/arm_part.hpp"
#include "multibody/arm/event_crowding.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace snare::multibody {

/// Takes an arm from event to event: which modes are over, when its drives change, and how far nothing else
/// jumps. Who integrates asks it after every step; alone and in a coupled run alike.         theory.md (A.14)
class ArmStepper {
 public:
  /// Part and switches stay the caller's and outlive the stepper.
  ArmStepper(ElasticArmPart& part, const std::vector<DriveSwitch>& switches);

  /// Time of the first jump behind `time` that is no event, at most `end` [s]: ends of courses and loads,
  /// switches. From the time of a switch by torque on the part watches that.
  [[nodiscard]] double next_break(double time, double end);
  /// Events of the modes that are over at the end of a step: those that were found (IDA's, one a function of
  /// the part;
  /// empty: none), and those left from their very edge, where no sign changes. The torque of a switch is not
  /// among them.
  [[nodiscard]] std::vector<int> ended_modes(const numerics::DaePoint& at, std::span<const int> found);
  /// Whether the step has ended at the torque of a switch.
  [[nodiscard]] bool torque_reached() const { return torque_reached_; }
  /// Told the modes that are over at a time [s]: why the integration cannot go on, where a joint's events
  /// crowd.
  [[nodiscard]] std::optional<std::string> crowding(const std::vector<int>& ended_modes, double time);
  /// The next switch, once its time [s] has come or its torque is reached; y in SI units. True: the drives
  /// are new.
  [[nodiscard]] bool change_drives(double time, Eigen::Ref<Eigen::VectorXd> y);

  /// Appends to a memory what the part does not remember itself, and takes it back: switches and crowding of
  /// events. Times [s].
  void save_state(std::vector<double>& memory) const;
  void restore_state(std::span<const double>& memory);

 private:
  ElasticArmPart& part_;
  const std::vector<DriveSwitch>& switches_;
  EventCrowding crowding_;
  std::size_t next_switch_ = 0;
  bool torque_reached_ = false;
  std::vector<double> values_;
};

}  // namespace snare::multibody
