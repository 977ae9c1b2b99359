#include "multibody/arm/arm_stepper.hpp"

#include "base/index.hpp"

#include <algorithm>

namespace snare::multibody {

namespace {

using base::at;

// An event function below this is over without an event: of functions that are scaled to one, far above the
// accuracy of a found event.
constexpr double beyond = -1e-9;

}  // namespace

ArmStepper::ArmStepper(ElasticArmPart& part, const std::vector<DriveSwitch>& switches)
    : part_(part), switches_(switches), crowding_(part.arm().motors()) {}

double ArmStepper::next_break(double time, double end) {
  double next = end;
  const auto consider = [&](double t) {
    if (t > time && t < next) next = t;
  };
  consider(part_.next_break(time));
  part_.watch_torque(-1, 0.0);
  if (next_switch_ == switches_.size()) return next;
  const DriveSwitch& change = switches_[next_switch_];
  consider(change.time);
  if (change.joint >= 0 && change.time <= time) part_.watch_torque(change.joint, change.torque);
  return next;
}

std::vector<int> ArmStepper::ended_modes(const numerics::DaePoint& point, std::span<const int> found) {
  values_.resize(at(part_.event_count()));
  part_.events(point, values_);
  torque_reached_ = false;
  std::vector<int> ended;
  for (int event = 0; event < part_.event_count(); ++event) {
    const bool was_found = !found.empty() && found[at(event)] < 0;
    if (!was_found && !(values_[at(event)] < beyond)) continue;
    if (event == part_.torque_event()) {
      torque_reached_ = true;
    } else {
      ended.push_back(event);
    }
  }
  return ended;
}

std::optional<std::string> ArmStepper::crowding(const std::vector<int>& ended_modes, double time) {
  std::optional<std::string> stuck;
  for (const int event : ended_modes) {
    const int joint = ElasticArmPart::joint_of_event(event);
    if (!crowding_.crowded(joint, time)) continue;
    stuck = "joint " + part_.arm().joints[at(joint)].name +
            " stays at a jump of its law: a load between the torques on its two sides holds it there; "
            "give the jump a width (jump_width_deg)";
  }
  return stuck;
}

bool ArmStepper::change_drives(double time, Eigen::Ref<Eigen::VectorXd> y) {
  if (next_switch_ == switches_.size()) return false;
  const DriveSwitch& change = switches_[next_switch_];
  if (change.joint >= 0 ? !torque_reached_ : change.time > time) return false;
  torque_reached_ = false;
  ++next_switch_;
  part_.set_drives(change.drives);
  part_.stop_ruled_motors(y);
  return true;
}

void ArmStepper::save_state(std::vector<double>& memory) const {
  memory.push_back(static_cast<double>(next_switch_));
  crowding_.save_state(memory);
}

void ArmStepper::restore_state(std::span<const double>& memory) {
  next_switch_ = std::min(static_cast<std::size_t>(numerics::take(memory)), switches_.size());
  crowding_.restore_state(memory);
  if (next_switch_ > 0) part_.set_drives(switches_[next_switch_ - 1].drives);
}

}  // namespace snare::multibody
