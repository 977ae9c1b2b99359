#pragma once

#include "base/index.hpp"
#include "coupling/dynamics/joints/bushing_part.hpp"
#include "coupling/dynamics/joints/carried_wire.hpp"
#include "coupling/dynamics/joints/load_part.hpp"
#include "coupling/dynamics/joints/mount_part.hpp"
#include "coupling/dynamics/joints/weld_part.hpp"
#include "coupling/dynamics/model/complaints.hpp"
#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/options.hpp"
#include "coupling/dynamics/model/result.hpp"
#include "multibody/arm/arm_stepper.hpp"

#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace snare::coupling {

/// Arms, welds, moving mounts and bushings of one run.                        theory.md (M.15)-(M.17), (M.22)
/// Unknowns y, their changes dv, their rates and all multipliers are those of the whole run, in SI units;
/// times in s.
class ConstraintSet {
 public:
  /// What is wrong with them.
  static void check(const Motion& motion, Complaints& complaints);
  /// And with one carrier.
  static void check_carrier(const Motion& motion, const std::string& name, const MotionCarrier& carrier,
                            Complaints& complaints);

  ConstraintSet(const Motion& motion, std::deque<wire::RodPart>& rods, const std::deque<BodyPart>& bodies,
                const MotionOptions& options);

  /// Last among the parts of the system, in this order.
  void append(std::vector<numerics::DaePart*>& parts);
  [[nodiscard]] int event_count() const;

  /// Writes into y the arms' start and the velocities of everything that is held, from those of its carriers.
  /// A wire without velocities of its own starts with its carriers: see CarriedWire.
  void place(Eigen::VectorXd& y);
  /// Writes the rates [rad/s] of the edges' angles of the wires that start with their carriers.
  void place_twist_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const;
  /// Multipliers zero.
  void zero_multipliers(Eigen::VectorXd& y) const;
  /// Rates of the arms that annul their rows of a residual with vanishing rates of theirs.
  void solve_rates(double time, const Eigen::VectorXd& y, const Eigen::VectorXd& rows, Eigen::VectorXd& rate);
  /// Adds to changes of the velocities what the constraints make of them.                    theory.md (M.16)
  void project(const Eigen::VectorXd& y, Eigen::VectorXd& dv) const;
  /// Adds to free rates the accelerations of the constraints' forces; returns the multipliers.
  Eigen::VectorXd hold_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const;
  /// Puts multipliers, one constraint behind another as `hold_rates` returns them, into y.
  void set_multipliers(const Eigen::VectorXd& multipliers, Eigen::VectorXd& y) const;

  /// Time up to which nothing of the arms jumps but by an event [s].
  [[nodiscard]] double limit() const { return limit_; }
  /// After a step: leaves the modes that are over, and changes drives at their times. found: IDA's events of
  /// the arms, empty when it found none. True: the integration must be restarted.
  [[nodiscard]] bool process_events(const numerics::DaePoint& at, std::span<const int> found,
                                    Eigen::VectorXd& y);
  /// A new drive of a joint from a time on. The integration must be restarted.
  void change_drive(int arm, int joint, const multibody::Drive& drive, double time, Eigen::VectorXd& y);
  /// The same where the unknowns have taken it in already: behind it `restore_state` must follow.
  void restore_drive(int arm, int joint, const multibody::Drive& drive);
  [[nodiscard]] const multibody::ElasticArmPart& arm(int index) const { return *arms_[base::at(index)].part; }
  /// The frame that a carrier holds where it is wanted at the start.
  [[nodiscard]] MovingFrame frame_of(const MotionCarrier& carrier, const std::deque<BodyPart>& bodies,
                                     const multibody::Pose& X_WF) const;
  /// Appends to a memory what the parts do not remember themselves, and takes it back at a time: see
  /// ArmStepper. All that these parts remember, in SI units.
  void save_state(std::vector<double>& memory) const;
  void restore_state(double time, std::span<const double>& memory);
  /// Why it cannot go on, if so.
  [[nodiscard]] const std::optional<std::string>& stuck() const { return stuck_; }

  /// Energy that the arms have lost up to here [J]: with that of the integrals it is all that is dissipated.
  /// y in SI units.
  [[nodiscard]] double lost(const numerics::VectorView& y) const;
  /// Adds the arms' energies and works, and their momentum when nothing holds their base.
  void add_energy(const numerics::VectorView& y, EnergyBalance& energy, MotionSample* sample) const;
  /// Forces that count as outer ones [N], their moments about the origin [N m], the power of driven carriers
  /// [W], and what bushings lose [W].
  struct Outer {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    double power = 0.0;
    double lost = 0.0;
  };
  [[nodiscard]] Outer outer(const numerics::DaePoint& at) const;
  /// What forces between frames, and loads, add to that.
  void add_load(const LoadPart& load, const numerics::DaePoint& at, Outer& sum) const;
  void add_forces(const FrameForces& forces, const std::vector<multibody::Wrench>& wrenches,
                  const numerics::DaePoint& at, Outer& sum) const;
  /// Force of a moving mount on its wire's end, if the end has one [N].
  [[nodiscard]] std::optional<Eigen::Vector3d> mount_force(int wire, wire::End end,
                                                           const numerics::VectorView& y) const;
  /// Forces of moving mounts into a sample, and the arms' coordinates.
  void fill(double time, const numerics::VectorView& y, MotionSample& sample) const;
  /// How far the constraint that misses most is from being kept, see Constraint::gap [m].
  [[nodiscard]] double largest_gap(const numerics::VectorView& y) const;

 private:
  struct Arm {
    multibody::ElasticArm model;
    std::optional<multibody::ElasticArmPart> part;
    std::optional<multibody::ArmStepper> stepper;
    bool floats = false;  // nothing holds its base: its momentum is counted
  };
  [[nodiscard]] bool in_momentum_balance(const MovingFrame& frame) const;
  [[nodiscard]] std::vector<CarriedWire> carried_wires(const Eigen::VectorXd& y) const;
  void begin_interval(double time);

  const Motion& motion_;
  double end_;
  double limit_ = 0.0;
  std::deque<Arm> arms_;
  std::deque<WeldPart> welds_;
  std::deque<MountPart> mounts_;
  std::deque<BushingPart> bushings_;
  std::vector<const BodyPart*> held_;  // by each weld
  std::vector<const Constraint*> constraints_;
  std::optional<std::string> stuck_;
};

}  // namespace snare::coupling
