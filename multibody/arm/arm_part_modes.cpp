#include "multibody/arm/arm_part.hpp"

#include "base/index.hpp"
#include "numerics/dense_solvers.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace snare::multibody {

namespace {

using base::at;

/// What an event function shows that is not watched.
constexpr double never = 1.0;

}  // namespace

double ElasticArmPart::joint_torque(numerics::VectorView y, int joint) const {
  const ElasticJoint& j = arm_.joints[at(joint)];
  const TreeBody& body = arm_.tree.body(j.body);
  const int branch = modes_[at(joint)].branch;
  const double d = y[q_ + body.q_index] - y[motor_ + joint];
  const double rate = y[v_ + body.v_index] - y[rate_ + joint];
  const double damping =
      j.spring.damping_rate() == DampingRate::deflection ? j.spring.damping(branch, d) : 0.0;
  return j.spring.torque(branch, d) + damping * rate;
}

void ElasticArmPart::events(const numerics::DaePoint& point, std::span<double> values) {
  values[at(torque_event())] =
      watched_joint_ < 0 ? never : 1.0 - std::abs(joint_torque(point.y, watched_joint_)) / watched_torque_;
  for (int k = 0; k < arm_.motors(); ++k) {
    const ElasticJoint& joint = arm_.joints[at(k)];
    const JointMode& mode = modes_[at(k)];
    const Drive& drive = drives_[at(k)];
    const std::span<double> of_joint = values.subspan(at(events_per_joint * k), events_per_joint);
    for (double& value : of_joint) value = never;
    const auto g = [&](JointEvent kind) -> double& { return of_joint[static_cast<std::size_t>(kind)]; };

    const double d = point.y[q_ + arm_.tree.body(joint.body).q_index] - point.y[motor_ + k];
    const double low = joint.spring.lower_end(mode.branch), high = joint.spring.upper_end(mode.branch);
    const double scale = joint.spring.pieces().size() > 1 ? joint.spring.pieces()[1].from : 1.0;
    if (std::isfinite(low)) g(JointEvent::spring_lower) = (d - low) / scale;
    if (std::isfinite(high)) g(JointEvent::spring_upper) = (high - d) / scale;

    const JointFriction law = friction(k);
    if (!drive.rules() && law.sticks()) {
      if (mode.turning == 0) {
        const double applied = joint_torque(point.y, k) + drive_torque(point.time, point.y, k) - law.offset;
        g(JointEvent::turn_forward_or_rest) = (law.breakaway - applied) / law.breakaway;
        g(JointEvent::turn_backward) = (law.breakaway + applied) / law.breakaway;
      } else {
        g(JointEvent::turn_forward_or_rest) = mode.turning * point.y[rate_ + k] / law.stribeck_velocity;
      }
    }
    if (drive.mode == DriveMode::servo && std::isfinite(drive.limit)) {
      const double demand =
          drive.demand(inside(point.time), point.y[motor_ + k], point.y[rate_ + k]) / drive.limit;
      if (mode.saturated == 0) {
        g(JointEvent::limit_upper_or_leave) = 1.0 - demand;
        g(JointEvent::limit_lower) = 1.0 + demand;
      } else {
        g(JointEvent::limit_upper_or_leave) = mode.saturated * demand - 1.0;
      }
    }
  }
}

void ElasticArmPart::watch_torque(int joint, double torque) {
  watched_joint_ = joint;
  watched_torque_ = torque;
}

void ElasticArmPart::enter_interval(double begin, double end) {
  interval_begin_ = begin;
  interval_end_ = end;
}

void ElasticArmPart::save_state(std::vector<double>& memory) const {
  for (const JointMode& mode : modes_) {
    for (const int value : {mode.branch, mode.turning, mode.saturated}) memory.push_back(value);
  }
}

void ElasticArmPart::restore_state(const numerics::VectorView& /*y*/, std::span<const double>& memory) {
  for (JointMode& mode : modes_) {
    for (int* value : {&mode.branch, &mode.turning, &mode.saturated})
      *value = static_cast<int>(numerics::take(memory));
  }
}

void ElasticArmPart::settle(double time, numerics::VectorView y) {
  for (int k = 0; k < arm_.motors(); ++k) {
    const ElasticJoint& joint = arm_.joints[at(k)];
    JointMode& mode = modes_[at(k)];
    mode = {};
    mode.branch = joint.spring.branch_of(y[q_ + arm_.tree.body(joint.body).q_index] - y[motor_ + k]);
    const Drive& drive = drives_[at(k)];
    if (drive.mode == DriveMode::servo) {
      const double demand = drive.demand(inside(time), y[motor_ + k], y[rate_ + k]);
      if (std::abs(demand) > drive.limit) mode.saturated = demand > 0.0 ? 1 : -1;
    }
    const JointFriction law = friction(k);
    const double rate = y[rate_ + k];
    mode.turning = rate < 0.0 ? -1 : 1;
    if (!drive.rules() && law.sticks() && rate == 0.0) {
      mode.turning = law.leaves(joint_torque(y, k) + drive_torque(time, y, k));
    }
  }
}

void ElasticArmPart::leave_modes(double time, Eigen::Ref<Eigen::VectorXd> y,
                                 const std::vector<int>& ended_modes) {
  for (const int event : ended_modes) {
    const int k = joint_of_event(event);
    JointMode& mode = modes_[at(k)];
    switch (kind_of_event(event)) {
      case JointEvent::spring_lower:
        --mode.branch;
        break;
      case JointEvent::spring_upper:
        ++mode.branch;
        break;
      case JointEvent::turn_forward_or_rest:
        if (mode.turning == 0) {
          mode.turning = 1;
        } else {  // come to rest: what acts now decides
          y[rate_ + k] = 0.0;
          mode.turning = friction(k).leaves(joint_torque(y, k) + drive_torque(time, y, k));
        }
        break;
      case JointEvent::turn_backward:
        mode.turning = -1;
        break;
      case JointEvent::limit_upper_or_leave:
        mode.saturated = mode.saturated == 0 ? 1 : 0;
        break;
      case JointEvent::limit_lower:
        mode.saturated = -1;
        break;
    }
  }
}

void ElasticArmPart::set_drives(std::vector<Drive> drives) {
  drives_ = std::move(drives);
}

void ElasticArmPart::stop_ruled_motors(Eigen::Ref<Eigen::VectorXd> y) const {
  for (int k = 0; k < arm_.motors(); ++k) {
    if (!drives_[at(k)].rules()) continue;
    y[lost()] += 0.5 * arm_.joints[at(k)].motor_inertia * y[rate_ + k] * y[rate_ + k];
    y[rate_ + k] = 0.0;
  }
}

void ElasticArmPart::write_state(const ArmState& state, Eigen::Ref<Eigen::VectorXd> y) const {
  y.segment(q_, arm_.tree.coordinates()) = state.q;
  y.segment(v_, arm_.tree.velocities()) = state.v;
  y.segment(motor_, arm_.motors()) = state.motor;
  y.segment(rate_, arm_.motors()) = state.motor_rate;
  for (int k = 0; k < arm_.motors(); ++k) {
    if (drives_[at(k)].mode == DriveMode::locked) y[rate_ + k] = 0.0;  // its brake is on
  }
  y.segment(work_, 3).setZero();
  if (base_ == BaseEquations::momentum) {
    Kinematics kinematics(arm_.tree);
    place(arm_.tree, state.q, kinematics);
    set_moving(arm_.tree, state.v, kinematics);
    y.segment<6>(momentum_) = momentum(arm_.tree, kinematics).vector();
  }
}

ArmState ElasticArmPart::state(numerics::VectorView y) const {
  return {y.segment(q_, arm_.tree.coordinates()), y.segment(v_, arm_.tree.velocities()),
          y.segment(motor_, arm_.motors()), y.segment(rate_, arm_.motors())};
}

ArmWork ElasticArmPart::work(numerics::VectorView y) const {
  return {y[drive_work()], y[load_work()], y[lost()]};
}

void ElasticArmPart::write_rate(double time, numerics::VectorView y, Eigen::Ref<Eigen::VectorXd> rate) {
  // Residual of a vanishing y' less the inertial terms gives every rate but the accelerations of the tree.
  const Tree& tree = arm_.tree;
  const int nv = tree.velocities();
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(y.size());
  Eigen::VectorXd rows = none;
  residual({time, y, none}, rows);
  rate.segment(q_, tree.coordinates()) = -rows.segment(q_, tree.coordinates());
  rate.segment(work_, 3) = -rows.segment(work_, 3);
  if (base_ == BaseEquations::momentum) rate.segment<6>(momentum_) = -rows.segment<6>(momentum_);
  rate.segment(motor_, arm_.motors()) = y.segment(rate_, arm_.motors());
  for (int k = 0; k < arm_.motors(); ++k) {
    const Drive& drive = drives_[at(k)];
    rate[rate_ + k] = drive.mode == DriveMode::course ? drive.course.acceleration(inside(time))
                                                      : -rows[rate_ + k] / arm_.joints[at(k)].motor_inertia;
  }

  Eigen::VectorXd torque = Eigen::VectorXd::Zero(nv);
  for (int k = 0; k < arm_.motors(); ++k)
    torque[tree.body(arm_.joints[at(k)].body).v_index] = -joint_torque(y, k);
  rate.segment(v_, nv) = forward_dynamics(tree, y.segment(q_, tree.coordinates()), y.segment(v_, nv), torque,
                                          wrenches_, workspace_);
}

void ElasticArmPart::solve_rates(double time, numerics::VectorView y, numerics::VectorView rows,
                                 Eigen::Ref<Eigen::VectorXd> rate) {
  assert(base_ == BaseEquations::newton_euler &&
         "with the momentum as an unknown nothing else acts on the arm");
  const Tree& tree = arm_.tree;
  const auto annul = [&](int first, int count) { rate.segment(first, count) = -rows.segment(first, count); };
  annul(q_, tree.coordinates());
  annul(work_, 3);
  annul(motor_, arm_.motors());
  for (int k = 0; k < arm_.motors(); ++k) {
    const Drive& drive = drives_[at(k)];
    rate[rate_ + k] = drive.mode == DriveMode::course ? drive.course.acceleration(inside(time))
                                                      : -rows[rate_ + k] / arm_.joints[at(k)].motor_inertia;
  }
  const Eigen::MatrixXd& H = mass_matrix(tree, y.segment(q_, tree.coordinates()), workspace_);
  rate.segment(v_, tree.velocities()) = -numerics::solve_symmetric(H, rows.segment(v_, tree.velocities()));
}

double ElasticArmPart::next_break(double time) const {
  double next = std::numeric_limits<double>::infinity();
  for (const Drive& drive : drives_) next = std::min(next, drive.next_break(time));
  for (const TimedLoad& load : loads_) {
    for (const double t : {load.begin, load.begin + load.duration})
      if (t > time) next = std::min(next, t);
  }
  return next;
}

}  // namespace snare::multibody
