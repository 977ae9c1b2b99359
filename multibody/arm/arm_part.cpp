#include "multibody/arm/arm_part.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace snare::multibody {

namespace {

using base::at;

}  // namespace

BaseEquations best_base_equations(const Tree& tree) {
  bool one_base = tree.size() > 0 && tree.body(0).joint == JointKind::free && tree.gravity.isZero(0.0);
  for (int i = 1; i < tree.size(); ++i) one_base = one_base && tree.body(i).parent >= 0;
  return one_base ? BaseEquations::momentum : BaseEquations::newton_euler;
}

double TimedLoad::share(double time) const {
  if (time < begin || time > begin + duration) return 0.0;
  return shape == Shape::constant ? 1.0 : std::sin(std::numbers::pi * (time - begin) / duration);
}

/// Torques at a joint and their derivatives, in its present mode.
struct ElasticArmPart::Terms {
  double deflection, deflection_rate, motor_rate;
  double damping;  // of the present branch
  double torque;   // of spring and damper on the motor
  double motor_loss,
      motor_loss_slope;  // torque against the motor: dry and viscous friction, damping of the motor's rate
  double drive, drive_by_angle, drive_by_rate;
  double drive_by_q, drive_by_v;  // of a course, which gives whatever torque it takes
  double gear_damping;            // damping on the deflection rate, 0 where it acts on the motor
  double torque_by_deflection;    // at fixed rates
  double loss_by_deflection;      // of the torque against the motor
  double gear_damping_slope;      // by the deflection
};

ElasticArmPart::ElasticArmPart(const ElasticArm& arm, std::vector<Drive> drives, std::vector<TimedLoad> loads,
                               const ArmTolerances& tolerances, BaseEquations base)
    : arm_(arm),
      drives_(std::move(drives)),
      loads_(std::move(loads)),
      modes_(at(arm.motors())),
      tolerances_(tolerances),
      base_(base),
      interval_begin_(-std::numeric_limits<double>::infinity()),
      interval_end_(std::numeric_limits<double>::infinity()),
      workspace_(arm.tree),
      derivatives_(arm.tree),
      kinematics_(arm.tree),
      seen_(arm.tree),
      q_values_(arm.tree.coordinates()),
      v_values_(arm.tree.velocities()),
      a_values_(arm.tree.velocities()) {
  assert(static_cast<int>(drives_.size()) == arm.motors());
  wrenches_.reserve(at(arm.tree.size()));
}

void ElasticArmPart::declare(numerics::DaeLayout& layout) {
  const int m = arm_.motors();
  const ArmTolerances& t = tolerances_;
  constexpr auto kind = numerics::DaeKind::differential;
  q_ = layout.add(
      {"arm coordinate", {}, arm_.tree.coordinates(), kind, t.coordinate, 0, t.relative_coordinates});
  v_ = layout.add({"arm velocity", {}, arm_.tree.velocities(), kind, t.rate});
  motor_ = layout.add({"motor angle [rad]", {}, m, kind, t.coordinate, 0, t.relative_coordinates});
  rate_ = layout.add({"motor rate [rad/s]", {}, m, kind, t.rate});
  work_ = layout.add({"work [J]", {"motors", "loads", "lost"}, 3, kind, t.work});
  if (base_ == BaseEquations::momentum) {
    momentum_ = layout.add({"momentum", {}, 6, kind, t.rate * arm_.tree.mass()});
  }
}

template <class Keep>
void ElasticArmPart::for_each_entry(const Keep& keep) const {
  const Tree& tree = arm_.tree;
  for (const TreeBody& body : tree.bodies()) {
    const int q = q_ + body.q_index, v = v_ + body.v_index;
    for (int i = 0; i < body.coordinates(); ++i) {
      for (int j = 0; j < body.coordinates(); ++j) keep(&Slots::coordinate, q + i, q + j);
      for (int j = 0; j < body.velocities(); ++j) keep(&Slots::coordinate, q + i, v + j);
    }
  }
  for (int j = 0; j < tree.coordinates(); ++j) {
    for (int i = 0; i < tree.velocities(); ++i) keep(&Slots::motion_by_q, v_ + i, q_ + j);
  }
  for (int j = 0; j < tree.velocities(); ++j) {
    for (int i = 0; i < tree.velocities(); ++i) keep(&Slots::motion_by_v, v_ + i, v_ + j);
  }
  for (const int row : {drive_work(), load_work(), lost()}) keep(&Slots::work, row, row);
  for (int j = 0; !loads_.empty() && j < tree.coordinates(); ++j)
    keep(&Slots::work_by_q, load_work(), q_ + j);
  for (int j = 0; !loads_.empty() && j < tree.velocities(); ++j) keep(&Slots::work_by_v, load_work(), v_ + j);
  if (base_ != BaseEquations::momentum) return;
  for (int i = 0; i < 6; ++i) {
    keep(&Slots::momentum, v_ + i, momentum_ + i);
    keep(&Slots::momentum, momentum_ + i, momentum_ + i);
  }
  for (int j = 0; !loads_.empty() && j < tree.coordinates(); ++j) {
    for (int i = 0; i < 3; ++i) keep(&Slots::momentum_by_q, momentum_ + i, q_ + j);
  }
}

void ElasticArmPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  for_each_entry([&entries](auto /*group*/, int i, int j) { entries.emplace_back(i, j); });
  for (int k = 0; k < arm_.motors(); ++k) {
    const TreeBody& body = arm_.tree.body(arm_.joints[at(k)].body);
    for (const int row : {v_ + body.v_index, rate_ + k, drive_work(), lost()}) {
      for (const int column : {q_ + body.q_index, v_ + body.v_index, motor_ + k, rate_ + k})
        entries.emplace_back(row, column);
    }
    entries.emplace_back(motor_ + k, motor_ + k);
    entries.emplace_back(motor_ + k, rate_ + k);
  }
}

void ElasticArmPart::attach_pattern(const numerics::SparseMatrix& pattern) {
  joint_slots_.clear();
  slots_ = {};
  for_each_entry([&](auto group, int i, int j) { (slots_.*group).push_back(pattern.slot(i, j)); });
  for (int k = 0; k < arm_.motors(); ++k) {
    const TreeBody& body = arm_.tree.body(arm_.joints[at(k)].body);
    const auto slots_of = [&](int row) {
      return JointSlots::Row{pattern.slot(row, q_ + body.q_index), pattern.slot(row, v_ + body.v_index),
                             pattern.slot(row, motor_ + k), pattern.slot(row, rate_ + k)};
    };
    joint_slots_.push_back({slots_of(v_ + body.v_index), slots_of(motor_ + k), slots_of(rate_ + k),
                            slots_of(drive_work()), slots_of(lost())});
  }
}

double ElasticArmPart::inside(double time) const {
  const double margin = 1e-12 * (1.0 + std::abs(time));  // far below every time that matters
  return std::clamp(time, interval_begin_ + margin,
                    std::max(interval_begin_ + margin, interval_end_ - margin));
}

JointFriction ElasticArmPart::friction(int joint) const {
  const ElasticJoint& j = arm_.joints[at(joint)];
  return drives_[at(joint)].mode == DriveMode::limp ? j.friction.with_back_drive(j.back_drive) : j.friction;
}

bool ElasticArmPart::fixed(int joint) const {
  const DriveMode mode = drives_[at(joint)].mode;
  return mode == DriveMode::locked || (mode != DriveMode::course && modes_[at(joint)].turning == 0);
}

ElasticArmPart::Terms ElasticArmPart::terms(double time, numerics::VectorView y, int joint) const {
  const ElasticJoint& j = arm_.joints[at(joint)];
  const TreeBody& body = arm_.tree.body(j.body);
  const JointMode& mode = modes_[at(joint)];
  const Drive& drive = drives_[at(joint)];
  Terms t{};
  t.motor_rate = y[rate_ + joint];
  t.deflection = y[q_ + body.q_index] - y[motor_ + joint];
  t.deflection_rate = y[v_ + body.v_index] - t.motor_rate;
  t.damping = j.spring.damping(mode.branch, t.deflection);
  const double slope = j.spring.damping_slope(mode.branch, t.deflection);
  const bool in_gear = j.spring.damping_rate() == DampingRate::deflection;
  t.gear_damping = in_gear ? t.damping : 0.0;
  t.gear_damping_slope = in_gear ? slope : 0.0;
  t.torque = j.spring.torque(mode.branch, t.deflection) + t.gear_damping * t.deflection_rate;
  t.torque_by_deflection = j.spring.stiffness(mode.branch) + t.gear_damping_slope * t.deflection_rate;
  if (!fixed(joint)) {
    const JointFriction law = friction(joint);
    const double motor_damping = t.damping - t.gear_damping;
    const int turning = drive.mode == DriveMode::course ? (t.motor_rate < 0.0 ? -1 : 1) : mode.turning;
    t.motor_loss = law.torque(turning, t.motor_rate) + motor_damping * t.motor_rate;
    t.motor_loss_slope = law.slope(turning, t.motor_rate) + motor_damping;
    t.loss_by_deflection = in_gear ? 0.0 : slope * t.motor_rate;
  }
  if (drive.mode == DriveMode::servo) {
    if (mode.saturated != 0) {
      t.drive = mode.saturated * drive.limit;
    } else {
      t.drive = drive.demand(inside(time), y[motor_ + joint], t.motor_rate);
      t.drive_by_angle = -drive.proportional;
      t.drive_by_rate = -drive.derivative;
    }
  }
  if (drive.mode == DriveMode::torque) t.drive = drive.demand(inside(time), 0.0, 0.0);
  if (drive.mode == DriveMode::course) {
    t.drive = j.motor_inertia * drive.course.acceleration(inside(time)) + t.motor_loss - t.torque;
    t.drive_by_q = t.loss_by_deflection - t.torque_by_deflection;
    t.drive_by_v = -t.gear_damping;
    t.drive_by_angle = -t.drive_by_q;
    t.drive_by_rate = t.motor_loss_slope + t.gear_damping;
  }
  return t;
}

const Kinematics& ElasticArmPart::kinematics(numerics::VectorView y) const {
  const auto q = y.segment(q_, arm_.tree.coordinates()), v = y.segment(v_, arm_.tree.velocities());
  const bool placed = seen_q_.size() == q.size() && seen_q_ == q;
  if (!placed) {
    seen_q_ = q;
    place(arm_.tree, seen_q_, seen_);
  }
  if (!placed || seen_v_ != v) {
    seen_v_ = v;
    set_moving(arm_.tree, seen_v_, seen_);
  }
  return seen_;
}

double ElasticArmPart::drive_torque(double time, numerics::VectorView y, int joint) const {
  const Drive& drive = drives_[at(joint)];
  if (drive.mode == DriveMode::course) return terms(time, y, joint).drive;
  if (drive.mode == DriveMode::torque) return drive.demand(inside(time), 0.0, 0.0);
  if (drive.mode != DriveMode::servo) return 0.0;
  if (modes_[at(joint)].saturated != 0) return modes_[at(joint)].saturated * drive.limit;
  return drive.demand(inside(time), y[motor_ + joint], y[rate_ + joint]);
}

bool ElasticArmPart::place_loads(double time, numerics::VectorView y) {
  wrenches_.clear();
  for (const TimedLoad& load : loads_) {
    const double share = load.share(inside(time));
    if (share == 0.0 || arm_.tree.frame(load.frame).body < 0) continue;
    if (wrenches_.empty()) {
      wrenches_.assign(at(arm_.tree.size()), {});
      q_values_ = y.segment(q_, arm_.tree.coordinates());
      v_values_ = y.segment(v_, arm_.tree.velocities());
      place(arm_.tree, q_values_, kinematics_);
      set_moving(arm_.tree, v_values_, kinematics_);
    }
    const Wrench now{share * load.peak.moment, share * load.peak.force};
    const BodyWrench on_body = world_wrench_on_frame(arm_.tree, kinematics_, load.frame, now);
    wrenches_[at(on_body.body)] += on_body.F_B;
  }
  return !wrenches_.empty();
}

void ElasticArmPart::residual(const numerics::DaePoint& point, Eigen::Ref<Eigen::VectorXd> rows) {
  const Tree& tree = arm_.tree;
  const bool loaded = place_loads(point.time, point.y);
  q_values_ = point.y.segment(q_, tree.coordinates());
  v_values_ = point.y.segment(v_, tree.velocities());
  a_values_ = point.rate.segment(v_, tree.velocities());
  // q' - N(q) v = 0
  rows.segment(q_, tree.coordinates()) += point.rate.segment(q_, tree.coordinates());
  for (const TreeBody& body : tree.bodies()) {
    if (body.joint == JointKind::free) {
      rows.segment<7>(q_ + body.q_index) -= free_coordinate_rate(body, q_values_, v_values_);
    } else {
      rows[q_ + body.q_index] -= v_values_[body.v_index];
    }
  }
  // Inertia less forces of the tree, or the momentum of its base.
  rows.segment(v_, tree.velocities()) +=
      inverse_dynamics(tree, q_values_, v_values_, a_values_, wrenches_, workspace_);
  rows.segment(work_, 3) += point.rate.segment(work_, 3);
  if (base_ == BaseEquations::momentum) use_momentum(point, loaded, rows);

  // Joints: + tau on the link, - tau on the motor, and the powers of drives and losses.
  for (int k = 0; k < arm_.motors(); ++k) {
    const Terms t = terms(point.time, point.y, k);
    const ElasticJoint& joint = arm_.joints[at(k)];
    rows[v_ + tree.body(joint.body).v_index] += t.torque;
    rows[motor_ + k] += point.rate[motor_ + k] - t.motor_rate;
    const Drive& drive = drives_[at(k)];
    if (drive.mode == DriveMode::course) {
      rows[rate_ + k] += joint.motor_inertia * (t.motor_rate - drive.course.rate(inside(point.time)));
    } else {
      rows[rate_ + k] += joint.motor_inertia * point.rate[rate_ + k];
      if (!fixed(k)) rows[rate_ + k] += t.motor_loss - t.torque - t.drive;
    }
    rows[drive_work()] -= t.drive * t.motor_rate;
    rows[lost()] -= t.gear_damping * t.deflection_rate * t.deflection_rate + t.motor_loss * t.motor_rate;
  }
  if (loaded) {
    for (int i = 0; i < tree.size(); ++i) rows[load_work()] -= dot(kinematics_.V_B[at(i)], wrenches_[at(i)]);
  }
}

void ElasticArmPart::jacobian(const numerics::DaePoint& point, double c, std::vector<double>& values) {
  const Tree& tree = arm_.tree;
  const int nq = tree.coordinates(), nv = tree.velocities();
  const bool loaded = place_loads(point.time, point.y);
  q_values_ = point.y.segment(q_, nq);
  v_values_ = point.y.segment(v_, nv);
  a_values_ = point.rate.segment(v_, nv);

  // q' - N(q) v, body by body.
  std::size_t slot = 0;
  for (const TreeBody& body : tree.bodies()) {
    if (body.joint != JointKind::free) {
      values[at(slots_.coordinate[slot++])] += c;
      values[at(slots_.coordinate[slot++])] -= 1.0;
      continue;
    }
    const FreeRateDerivatives d = differentiate_free_coordinate_rate(body, q_values_, v_values_);
    for (int i = 0; i < 7; ++i) {
      for (int j = 0; j < 7; ++j) {
        values[at(slots_.coordinate[slot++])] += (i == j ? c : 0.0) - d.by_coordinates(i, j);
      }
      for (int j = 0; j < 6; ++j) values[at(slots_.coordinate[slot++])] -= d.by_velocities(i, j);
    }
  }

  // The balances of the tree; a free body's coordinates move it by free_coordinate_motion.
  differentiate_inverse_dynamics(tree, q_values_, v_values_, a_values_, wrenches_, derivatives_);
  if (loaded) add_load_derivatives(point.time, values);
  if (base_ == BaseEquations::momentum) add_momentum_derivatives(point.time, c, values);
  for (const TreeBody& body : tree.bodies()) {
    for (int i = 0; i < nv; ++i) {
      if (body.joint != JointKind::free) {
        values[at(slots_.motion_by_q[at(body.q_index * nv + i)])] += derivatives_.position(i, body.v_index);
        continue;
      }
      const Eigen::Matrix<double, 6, 7> motion = free_coordinate_motion(body, q_values_);
      const Eigen::Matrix<double, 1, 7> row = derivatives_.position.row(i).segment<6>(body.v_index) * motion;
      for (int j = 0; j < 7; ++j) values[at(slots_.motion_by_q[at((body.q_index + j) * nv + i)])] += row[j];
    }
  }
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nv; ++i) {
      values[at(slots_.motion_by_v[at(j * nv + i)])] +=
          derivatives_.velocity(i, j) + c * derivatives_.mass(i, j);
    }
  }

  for (int k = 0; k < arm_.motors(); ++k) add_motor_derivatives(k, point, c, values);
  for (const int diagonal : slots_.work) values[at(diagonal)] += c;
}

void ElasticArmPart::add_motor_derivatives(int k, const numerics::DaePoint& point, double c,
                                           std::vector<double>& values) const {
  const Terms t = terms(point.time, point.y, k);
  const JointSlots& s = joint_slots_[at(k)];
  const auto add = [&values](int index, double value) { values[at(index)] += value; };
  // Balance of the link: + tau.
  add(s.link.q, t.torque_by_deflection);
  add(s.link.v, t.gear_damping);
  add(s.link.angle, -t.torque_by_deflection);
  add(s.link.rate, -t.gear_damping);
  // Balance of the motor: Im qm'' + losses - tau - drive, or Im (qm' - r').
  const bool on_course = drives_[at(k)].mode == DriveMode::course;
  add(s.motor_rate.rate, (on_course ? 1.0 : c) * arm_.joints[at(k)].motor_inertia);
  if (!fixed(k) && !on_course) {
    add(s.motor_rate.q, t.loss_by_deflection - t.torque_by_deflection);
    add(s.motor_rate.v, -t.gear_damping);
    add(s.motor_rate.angle, t.torque_by_deflection - t.loss_by_deflection - t.drive_by_angle);
    add(s.motor_rate.rate, t.gear_damping + t.motor_loss_slope - t.drive_by_rate);
  }
  add(s.motor_angle.angle, c);
  add(s.motor_angle.rate, -1.0);
  // Work of the drives, - drive qm', and what is lost, - gear damping times rate^2 - losses qm'.
  add(s.drive_work.q, -t.drive_by_q * t.motor_rate);
  add(s.drive_work.v, -t.drive_by_v * t.motor_rate);
  add(s.drive_work.angle, -t.drive_by_angle * t.motor_rate);
  add(s.drive_work.rate, -t.drive_by_rate * t.motor_rate - t.drive);
  add(s.lost.v, -2.0 * t.gear_damping * t.deflection_rate);
  add(s.lost.rate,
      2.0 * t.gear_damping * t.deflection_rate - t.motor_loss_slope * t.motor_rate - t.motor_loss);
  const double loss_by_deflection =
      t.gear_damping_slope * t.deflection_rate * t.deflection_rate + t.loss_by_deflection * t.motor_rate;
  add(s.lost.q, -loss_by_deflection);
  add(s.lost.angle, loss_by_deflection);
}

void ElasticArmPart::add_load_derivatives(double time, std::vector<double>& values) {
  // The loads keep their directions in the world; the derivatives above let them turn with the bodies.
  //                                                                                           theory.md (A.8)
  const Tree& tree = arm_.tree;
  for (const TimedLoad& load : loads_) {
    const double share = load.share(inside(time));
    if (share == 0.0 || tree.frame(load.frame).body < 0) continue;
    const Eigen::Vector3d M = share * load.peak.moment, F = share * load.peak.force;
    const Matrix6X J = frame_jacobian(tree, kinematics_, load.frame);
    const Matrix6X J_rate = frame_jacobian_rate(tree, kinematics_, load.frame);
    const FrameMotion motion = frame_motion(tree, kinematics_, load.frame);
    Eigen::VectorXd power_by_motion = Eigen::VectorXd::Zero(tree.velocities());
    for (int j = 0; j < tree.velocities(); ++j) {
      const Eigen::Vector3d w = J.col(j).head<3>();
      const Eigen::Vector3d turned_M = w.cross(M), turned_F = w.cross(F);
      for (int i = 0; i < tree.velocities(); ++i) {
        derivatives_.position(i, j) += J.col(i).head<3>().dot(turned_M) + J.col(i).tail<3>().dot(turned_F);
      }
    }
    // Change of the frame's motion J v along axis j: d(J_j)/dt, less J [v, e_j] where velocities are no rates
    // of coordinates, and with the turn of the angular velocity by the axis.
    for (const TreeBody& body : tree.bodies()) {
      for (int l = 0; l < body.velocities(); ++l) {
        const int j = body.v_index + l;
        Vector6 change = J_rate.col(j);
        change.head<3>() += J.col(j).head<3>().cross(motion.angular);
        if (body.joint == JointKind::free) {
          Twist unit;
          (l < 3 ? unit.angular : unit.linear) = Eigen::Vector3d::Unit(l % 3);
          const Twist own{v_values_.segment<3>(body.v_index), v_values_.segment<3>(body.v_index + 3)};
          change -= J.middleCols<6>(body.v_index) * cross(own, unit).vector();
        }
        power_by_motion[j] = M.dot(change.head<3>()) + F.dot(change.tail<3>());
      }
    }
    for (const TreeBody& body : tree.bodies()) {
      if (body.joint != JointKind::free) {
        values[at(slots_.work_by_q[at(body.q_index)])] -= power_by_motion[body.v_index];
      } else {
        const Eigen::Matrix<double, 1, 7> row =
            power_by_motion.segment<6>(body.v_index).transpose() * free_coordinate_motion(body, q_values_);
        for (int i = 0; i < 7; ++i) values[at(slots_.work_by_q[at(body.q_index + i)])] -= row[i];
      }
    }
    for (int j = 0; j < tree.velocities(); ++j) {
      values[at(slots_.work_by_v[at(j)])] -= J.col(j).head<3>().dot(M) + J.col(j).tail<3>().dot(F);
    }
  }
}

}  // namespace snare::multibody
