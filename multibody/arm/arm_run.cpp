#include "multibody/arm/arm_run.hpp"

#include "multibody/arm/arm_stepper.hpp"
#include "numerics/progress.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace snare::multibody {

namespace {

const char* name_of_event(int event) {
  switch (ElasticArmPart::kind_of_event(event)) {
    case JointEvent::spring_lower:
    case JointEvent::spring_upper:
      return "spring";
    case JointEvent::turn_forward_or_rest:
    case JointEvent::turn_backward:
      return "friction";
    case JointEvent::limit_upper_or_leave:
    case JointEvent::limit_lower:
      break;
  }
  return "servo limit";
}

/// An arm alone is asked for its energy to many digits: it begins as IDA does.
numerics::IdaOptions cautious(numerics::IdaOptions options) {
  options.cautious_start = true;
  return options;
}

/// One run: the part, the integrator, and what has been kept.
class Run {
 public:
  explicit Run(const ArmScenario& scenario)
      : scenario_(scenario),
        part_(scenario.arm, scenario.drives, scenario.loads, scenario.tolerances,
              best_base_equations(scenario.arm.tree)),
        system_({&part_}),
        ida_(system_, cautious(scenario.ida)),
        y_(Eigen::VectorXd::Zero(system_.size())),
        rate_(Eigen::VectorXd::Zero(system_.size())),
        stepper_(part_, scenario.switches),
        progress_(scenario.least_advance),
        effort_{0, scenario.begin} {}

  ArmHistory run() {
    part_.write_state(scenario_.initial, y_);
    double now = scenario_.begin;
    part_.settle(now, y_);
    keep(now, y_);
    next_sample_ = now + scenario_.sample;
    while (now < scenario_.end && history_.report.usable()) {
      const double limit = stepper_.next_break(now, scenario_.end);
      part_.enter_interval(now, limit);
      begin(now);
      const bool went_on = until(limit);
      now = ida_.time();
      y_ = ida_.y();
      if (!went_on) break;
      if (stepper_.change_drives(now, y_)) history_.events.push_back({now, -1, "switch"});
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
      const long evaluated = ida_.statistics().residuals;
      const numerics::IdaAdvance done = ida_.advance(limit);
      if (done == numerics::IdaAdvance::failed) {
        history_.report = ida_.report();
        return false;
      }
      keep_samples();
      if (scenario_.stop && scenario_.stop())
        return end_early(numerics::Termination::interrupted, "stopped on request");
      const long evaluations = ida_.statistics().residuals - evaluated;
      if (const auto stalled = progress_.add(ida_, evaluations, scenario_.end, effort_))
        return end_early(numerics::Termination::stalled, *stalled);
      if (done == numerics::IdaAdvance::reached_limit) return true;
      const std::vector<int> ended_modes =
          stepper_.ended_modes({ida_.time(), ida_.y(), ida_.rate()}, ida_.events_found());
      if (stepper_.torque_reached()) return true;
      if (ended_modes.empty()) continue;
      if (const auto stuck = stepper_.crowding(ended_modes, ida_.time()))
        return end_early(numerics::Termination::step_too_small, *stuck);
      y_ = ida_.y();
      for (const int event : ended_modes) {
        history_.events.push_back({ida_.time(), ElasticArmPart::joint_of_event(event), name_of_event(event)});
      }
      part_.leave_modes(ida_.time(), y_, ended_modes);
      begin(ida_.time());
    }
  }

  /// Ends where the integrator stands, for a reason that is not its own; false.
  bool end_early(numerics::Termination termination, const std::string& why) {
    history_.report.termination = termination;
    history_.report.time = ida_.time();
    history_.report.message = why;
    return false;
  }

  void keep_samples() {
    while (next_sample_ <= ida_.time() && next_sample_ <= scenario_.end) {
      keep(next_sample_, ida_.interpolate(next_sample_));
      if (scenario_.progress) scenario_.progress(next_sample_);
      next_sample_ = scenario_.begin + scenario_.sample * static_cast<double>(history_.samples.size());
    }
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
  ArmStepper stepper_;
  numerics::Progress progress_;
  numerics::Effort effort_;
  double next_sample_ = 0.0;
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
