#include "multibody/arm/arm_run.hpp"

#include "base/index.hpp"
#include "multibody/arm/event_crowding.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace snare::multibody {

namespace {

using base::at;

const char* name_of_event(int event) {
  switch (event % ElasticArmPart::events_per_joint) {
    case 0:
    case 1:
      return "spring";
    case 2:
    case 3:
      return "friction";
    default:
      return "servo limit";
  }
}

/// One run: the part, the integrator, and what has been kept.
class Run {
 public:
  explicit Run(const ArmScenario& scenario)
      : scenario_(scenario),
        part_(scenario.arm, scenario.drives, scenario.loads, scenario.tolerances,
              best_base_equations(scenario.arm.tree)),
        system_({&part_}),
        ida_(system_, scenario.ida),
        y_(Eigen::VectorXd::Zero(system_.size())),
        rate_(Eigen::VectorXd::Zero(system_.size())),
        crowding_(scenario.arm.motors()) {}

  ArmHistory run() {
    part_.write_state(scenario_.initial, y_);
    double now = scenario_.begin;
    part_.settle(now, y_);
    keep(now, y_);
    next_sample_ = now + scenario_.sample;
    while (now < scenario_.end && history_.report.usable()) {
      const double limit = next_break(now);
      part_.enter_interval(now, limit);
      begin(now);
      const bool went_on = until(limit);
      now = ida_.time();
      y_ = ida_.y();
      if (!went_on) break;
      change_drives(now);
      part_.settle(now, y_);
    }
    history_.statistics = ida_.statistics();
    if (history_.samples.back().time < now) keep(now, y_);
    close_balance();
    return std::move(history_);
  }

 private:
  void begin(double time) {
    part_.write_rate(time, y_, rate_);
    ida_.start(time, y_, rate_);
  }

  /// To a time, or to the switch that a torque sets off; false where the run ends early.
  bool until(double limit) {
    for (;;) {
      const numerics::IdaAdvance done = ida_.advance(limit);
      if (done == numerics::IdaAdvance::failed) {
        history_.report = ida_.report();
        return false;
      }
      if (!keep_samples()) return false;
      if (done == numerics::IdaAdvance::reached_limit) return true;
      const std::vector<int> ended_modes = ended_mode_events(done == numerics::IdaAdvance::event);
      if (ended_modes.empty()) continue;
      if (std::find(ended_modes.begin(), ended_modes.end(), part_.torque_event()) != ended_modes.end()) {
        torque_reached_ = true;
        return true;
      }
      if (crowding_.crowded(ended_modes.front() / ElasticArmPart::events_per_joint, ida_.time())) {
        history_.report.termination = numerics::Termination::step_too_small;
        history_.report.time = ida_.time();
        history_.report.message =
            "joint " + scenario_.arm.joints[at(ended_modes.front() / ElasticArmPart::events_per_joint)].name +
            " stays at a jump of its law: a load between the torques on its two sides holds it there; "
            "give the jump a width (jump_width_deg)";
        return false;
      }
      y_ = ida_.y();
      for (const int event : ended_modes) {
        history_.events.push_back(
            {ida_.time(), event / ElasticArmPart::events_per_joint, name_of_event(event)});
      }
      part_.leave_modes(ida_.time(), y_, ended_modes);
      begin(ida_.time());
    }
  }

  /// Modes that are over: those that IDA found, and those that were left from their very edge, where no sign changes.
  std::vector<int> ended_mode_events(bool found) {
    constexpr double beyond =
        -1e-9;  // of functions that are scaled to one; far above the accuracy of a found event
    event_values_.resize(at(system_.event_count()));
    system_.events({ida_.time(), ida_.y(), ida_.rate()}, event_values_);
    std::vector<int> ended_modes;
    for (int i = 0; i < system_.event_count(); ++i) {
      if ((found && ida_.events_found()[at(i)] < 0) || event_values_[at(i)] < beyond) ended_modes.push_back(i);
    }
    return ended_modes;
  }

  double next_break(double now) {
    double next = scenario_.end;
    const auto consider = [&](double time) {
      if (time > now && time < next) next = time;
    };
    for (const double time : part_.breaks()) consider(time);
    part_.watch_torque(-1, 0.0);
    if (switch_ < scenario_.switches.size()) {
      const DriveSwitch& change = scenario_.switches[switch_];
      consider(change.time);
      if (change.joint >= 0 && change.time <= now) part_.watch_torque(change.joint, change.torque);
    }
    return next;
  }

  void change_drives(double now) {
    if (switch_ == scenario_.switches.size()) return;
    const DriveSwitch& change = scenario_.switches[switch_];
    if (change.joint >= 0 ? !torque_reached_ : change.time > now) return;
    torque_reached_ = false;
    ++switch_;
    part_.set_drives(change.drives, y_);
    history_.events.push_back({now, -1, "switch"});
  }

  bool keep_samples() {
    while (next_sample_ <= ida_.time() && next_sample_ <= scenario_.end) {
      keep(next_sample_, ida_.interpolate(next_sample_));
      const double time = next_sample_;
      next_sample_ = scenario_.begin + scenario_.sample * static_cast<double>(history_.samples.size());
      if (scenario_.progress && !scenario_.progress(time)) {
        history_.report.termination = numerics::Termination::interrupted;
        history_.report.message = "stopped on request";
        history_.report.time = time;
        return false;
      }
    }
    return true;
  }

  void keep(double time, const Eigen::VectorXd& y) {
    const ElasticArm& arm = scenario_.arm;
    ArmSample sample;
    sample.time = time;
    sample.state = part_.state(y);
    sample.work = part_.work(y);
    sample.energy = total_energy(arm, sample.state);
    const int m = arm.motors();
    sample.deflection.resize(m);
    sample.joint_torque.resize(m);
    sample.drive_torque.resize(m);
    for (int k = 0; k < m; ++k) {
      sample.deflection[k] = deflection(arm, sample.state, k);
      sample.joint_torque[k] = part_.joint_torque(y, k);
      sample.drive_torque[k] = part_.drive_torque(time, y, k);
    }
    Kinematics kinematics(arm.tree);
    place(arm.tree, sample.state.q, kinematics);
    set_moving(arm.tree, sample.state.v, kinematics);
    sample.momentum = momentum(arm.tree, kinematics);
    history_.samples.push_back(std::move(sample));
  }

  void close_balance() {
    const double start = history_.samples.front().energy;
    double scale = 0.0, error = 0.0;
    for (const ArmSample& s : history_.samples) {
      scale =
          std::max({scale, std::abs(s.energy), std::abs(s.work.motors), std::abs(s.work.loads), s.work.lost});
      error = std::max(error, std::abs(s.energy - start - s.work.motors - s.work.loads + s.work.lost));
    }
    history_.energy_error = scale > 0.0 ? error / scale : 0.0;
  }

  const ArmScenario& scenario_;
  ElasticArmPart part_;
  numerics::DaeSystem system_;
  numerics::Ida ida_;
  Eigen::VectorXd y_, rate_;
  ArmHistory history_;
  std::size_t switch_ = 0;
  double next_sample_ = 0.0;
  std::vector<double> event_values_;
  EventCrowding crowding_;
  bool torque_reached_ = false;
};

}  // namespace

ArmHistory simulate(const ArmScenario& scenario) {
  const int m = scenario.arm.motors();
  const auto fits = [m](const std::vector<Drive>& drives) { return static_cast<int>(drives.size()) == m; };
  bool fit = fits(scenario.drives) && scenario.initial.motor.size() == m &&
             scenario.initial.motor_rate.size() == m &&
             scenario.initial.q.size() == scenario.arm.tree.coordinates() &&
             scenario.initial.v.size() == scenario.arm.tree.velocities();
  for (const DriveSwitch& change : scenario.switches) fit = fit && fits(change.drives) && change.joint < m;
  if (!fit) throw std::invalid_argument("an arm needs one drive, angle and rate for each of its joints");
  return Run(scenario).run();
}

}  // namespace snare::multibody
