#pragma once

#include "multibody/arm/elastic_arm.hpp"
#include "multibody/dynamics_derivatives.hpp"
#include "numerics/dae.hpp"

#include <Eigen/Core>

#include <span>
#include <utility>
#include <vector>

namespace snare::multibody {

/// A wrench on a frame, in the axes of the world, over a time.
struct TimedLoad {
  enum class Shape { constant, half_sine };
  int frame = 0;
  Wrench peak;                         ///< moment about the frame's origin, force
  double begin = 0.0, duration = 0.0;  ///< [s], duration > 0
  Shape shape = Shape::half_sine;

  [[nodiscard]] double share(double time) const;  ///< of the peak [-]
};

/// What a joint is doing; its equations are smooth as long as that stays.                    theory.md (A.14)
struct JointMode {
  int branch = 0;     ///< of the spring's law
  int turning = 1;    ///< direction of dry friction; 0: the motor sticks
  int saturated = 0;  ///< +1, -1: the servo is at its limit
};

/// Functions of a joint that say by falling below zero that a mode is over, in the order of `events`.
enum class JointEvent {
  spring_lower,          ///< the deflection leaves the branch downwards
  spring_upper,          ///< upwards
  turn_forward_or_rest,  ///< the motor that sticks breaks away forwards; the one that turns comes to rest
  turn_backward,         ///< the motor that sticks breaks away backwards
  limit_upper_or_leave,  ///< the servo reaches its upper limit; the one at a limit leaves it
  limit_lower            ///< the servo reaches its lower limit
};

/// Works since the start [J].
struct ArmWork {
  double motors = 0.0;  ///< done by the drives
  double loads = 0.0;   ///< done by the timed loads
  double lost = 0.0;    ///< in dampers, friction and brakes; never falls
};

/// How the motion of a free body that carries all others is written.
enum class BaseEquations {
  newton_euler,  ///< balance of forces on it; other parts may add theirs to its rows
  /// momentum as an unknown, h' = loads; the base follows from h = P(q, v). Keeps h exactly.
  ///                                                                                         theory.md (A.16)
  momentum
};
/// `momentum` for a tree on one free body without gravity, else `newton_euler`.
[[nodiscard]] BaseEquations best_base_equations(const Tree& tree);

/// Absolute tolerances of the integration.
struct ArmTolerances {
  double coordinate = 1e-7;          ///< [rad, m], > 0
  double rate = 1e-7;                ///< [rad/s, m/s], > 0
  double work = 1e-6;                ///< [J], > 0
  bool relative_coordinates = true;  ///< the relative tolerance acts on coordinates too
};

/// An elastic arm in a DAE: F(t, y, y') = 0 of q, v, qm, qm' and the works.          theory.md (A.9), (A.14)
///
///   q' - N(q) v = 0,   ID(q, v, v', loads) + tau = 0 in a joint's row,   qm' - (qm') = 0,
///   Im qm'' + losses - tau - drive = 0, or qm'' = 0 where the motor stands, or qm' = r' on a course,
///   works' - powers = 0
/// tau: torque of a joint's spring with its damper on the motor. Other parts attach to a frame of the arm:
/// `velocities` is also the first row of the equations of motion, to which -J^T F is added for a wrench F
/// with the frame's Jacobian of kinematics.hpp, and `coordinates`/`velocities` pick the unknowns. Unknowns y
/// of the whole run and their rates in SI units, times in s.
class ElasticArmPart : public numerics::DaePart {
 public:
  /// The arm stays the caller's and outlives the part.
  ElasticArmPart(const ElasticArm& arm, std::vector<Drive> drives, std::vector<TimedLoad> loads,
                 const ArmTolerances& tolerances = {}, BaseEquations base = BaseEquations::newton_euler);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;
  /// Those of JointEvent for each joint, then one for the watched torque.
  [[nodiscard]] int event_count() const override { return events_per_joint * arm_.motors() + 1; }
  void events(const numerics::DaePoint& at, std::span<double> values) override;
  /// The modes; drives and watched torque are for who sets them to remember.
  void save_state(std::vector<double>& memory) const override;
  void restore_state(const numerics::VectorView& y, std::span<const double>& memory) override;

  /// Modes that fit a state; at rest a joint with dry friction sticks when it can.
  void settle(double time, numerics::VectorView y);
  /// Enters the modes behind the given events (index as in `events`); a motor that sticks is at rest from
  /// here on.
  void leave_modes(double time, Eigen::Ref<Eigen::VectorXd> y, const std::vector<int>& ended_modes);
  [[nodiscard]] const std::vector<JointMode>& modes() const { return modes_; }

  /// New drives from here on.
  void set_drives(std::vector<Drive> drives);
  /// A motor that a brake or a course takes while it turns stops at once: its energy is lost.
  void stop_ruled_motors(Eigen::Ref<Eigen::VectorXd> y) const;
  [[nodiscard]] const std::vector<Drive>& drives() const { return drives_; }

  /// y with the given state and no work done.
  void write_state(const ArmState& state, Eigen::Ref<Eigen::VectorXd> y) const;
  [[nodiscard]] ArmState state(numerics::VectorView y) const;
  [[nodiscard]] ArmWork work(numerics::VectorView y) const;
  /// y' that belongs to y in the present modes, by forward dynamics.
  void write_rate(double time, numerics::VectorView y, Eigen::Ref<Eigen::VectorXd> rate);
  /// The rates that annul the rows of a residual at vanishing y' (of this part and of all that add to its
  /// rows).
  void solve_rates(double time, numerics::VectorView y, numerics::VectorView rows,
                   Eigen::Ref<Eigen::VectorXd> rate);
  /// Torque of a joint's spring with its damper on the motor [N m].
  [[nodiscard]] double joint_torque(numerics::VectorView y, int joint) const;
  /// Torque of a drive [N m].
  [[nodiscard]] double drive_torque(double time, numerics::VectorView y, int joint) const;

  /// The last event is the torque of this joint reaching this size; a negative joint: never. Torque [N m], >
  /// 0.
  void watch_torque(int joint, double torque);
  [[nodiscard]] int torque_event() const { return events_per_joint * arm_.motors(); }

  /// The integration stays within this time until told again: what jumps at its ends has its inner value
  /// there. Times [s].
  void enter_interval(double begin, double end);
  /// The first time after a time that the integration must stop at, an end of a course or of a load;
  /// infinity where there is none.
  [[nodiscard]] double next_break(double time) const;

  /// The arm whose equations these are.
  [[nodiscard]] const ElasticArm& arm() const { return arm_; }
  /// Poses and velocities of the tree at y. Kept until another y is asked for: many frames of an arm are
  /// asked for at one.
  [[nodiscard]] const Kinematics& kinematics(numerics::VectorView y) const;

  [[nodiscard]] int coordinates() const { return q_; }  ///< first of the coordinates
  [[nodiscard]] int velocities() const { return v_; }   ///< first of the velocities

  static constexpr int events_per_joint = 6;  ///< kinds of JointEvent
  [[nodiscard]] static int joint_of_event(int event) { return event / events_per_joint; }
  [[nodiscard]] static JointEvent kind_of_event(int event) {
    return static_cast<JointEvent>(event % events_per_joint);
  }

 private:
  /// Slots of the entries that a joint's torques add, by rows; columns: its coordinate and velocity, the
  /// motor's angle and rate; -1: none.
  struct JointSlots {
    struct Row {
      int q = -1, v = -1, angle = -1, rate = -1;
    };
    Row link, motor_angle, motor_rate, drive_work, lost;
  };
  /// Slots of all else, by what they hold.
  struct Slots {
    std::vector<int> coordinate, motion_by_q, motion_by_v, work, work_by_q, work_by_v, momentum,
        momentum_by_q;
  };
  struct Terms;
  /// keep(group of Slots, row, column) for every entry that belongs to no joint.
  template <class Keep>
  void for_each_entry(const Keep& keep) const;
  [[nodiscard]] Terms terms(double time, numerics::VectorView y, int joint) const;
  [[nodiscard]] JointFriction friction(int joint) const;
  [[nodiscard]] bool fixed(int joint) const;
  [[nodiscard]] double inside(double time) const;
  bool place_loads(double time, numerics::VectorView y);
  void use_momentum(const numerics::DaePoint& at, bool loaded, Eigen::Ref<Eigen::VectorXd> rows);
  void add_momentum_derivatives(double time, double c, std::vector<double>& values);
  void add_motor_derivatives(int k, const numerics::DaePoint& point, double c,
                             std::vector<double>& values) const;
  void add_load_derivatives(double time, std::vector<double>& values);

  const ElasticArm& arm_;
  std::vector<Drive> drives_;
  std::vector<TimedLoad> loads_;
  std::vector<JointMode> modes_;
  ArmTolerances tolerances_;
  BaseEquations base_;
  int watched_joint_ = -1;
  double watched_torque_ = 0.0;
  double interval_begin_, interval_end_;
  // First unknowns, and rows of the same index.
  int q_ = 0, v_ = 0, motor_ = 0, rate_ = 0, work_ = 0, momentum_ = 0;
  [[nodiscard]] int drive_work() const { return work_; }
  [[nodiscard]] int load_work() const { return work_ + 1; }
  [[nodiscard]] int lost() const { return work_ + 2; }

  DynamicsWorkspace workspace_;
  InverseDynamicsDerivatives derivatives_;
  Kinematics kinematics_;
  mutable Kinematics seen_;  // of kinematics(), at seen_q_ and seen_v_
  mutable Eigen::VectorXd seen_q_, seen_v_;
  std::vector<Wrench> wrenches_;  // empty while no load acts
  Eigen::VectorXd q_values_, v_values_, a_values_;

  std::vector<JointSlots> joint_slots_;
  Slots slots_;
};

}  // namespace snare::multibody
