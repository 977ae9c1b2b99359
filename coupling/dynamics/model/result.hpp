#pragma once

#include "coupling/dynamics/model/left_out_inertia.hpp"
#include "coupling/dynamics/model/strength.hpp"
#include "coupling/dynamics/model/tightness.hpp"
#include "multibody/arm/arm_part.hpp"
#include "multibody/rigid_body.hpp"
#include "multibody/spatial.hpp"
#include "numerics/ida.hpp"
#include "numerics/progress.hpp"

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace snare::coupling {

/// What a contact does at one time.
struct ContactSample {
  bool closed = false;
  double gap = 0.0;                                 ///< [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on the wire, world frame [N]
  double normal_force = 0.0;                        ///< [N], >= 0
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the wire's centreline [m]
  double arc = 0.0;                                 ///< material coordinate [m]
  double slip_speed = 0.0;                          ///< [m/s]
  bool sticking = false;                            ///< closed, with bristles of which some do not slide
  /// Of a shape on a wire: its closed stretches, the one that presses most first. Then the forces above are
  /// their sums, gap and place those of the first, or of the wire's nearest point while all are open.
  std::vector<ContactSample> points;
};

/// Energies [J] of all wires, free bodies and arms.
struct EnergyBalance {
  double kinetic = 0.0;
  double strain = 0.0;  ///< of wires, foundations, bristles, bushings and the springs of laws
  double potential = 0.0;
  double dissipated = 0.0;  ///< by damping, drag, friction, contact laws and joints, integrated along the run
  double work = 0.0;        ///< done by driven bodies, constant forces, drives and loads of arms
  /// kinetic + strain + potential + dissipated - work - the same at the start: what the integrator gained
  /// (negative: lost).
  double integrator = 0.0;
  /// Decreases of the integrated dissipation that were removed from it [J], >= 0: their sum along the run,
  /// part of integrator.
  double corrected = 0.0;
};

/// Velocities and loads of a wire's vertices at one time.
struct WireLoads {
  Eigen::Matrix3Xd velocities;  ///< [m/s]
  Eigen::VectorXd tensions;     ///< with damping; the mean of the two edges at a vertex [N]
  Eigen::VectorXd curvatures;   ///< bending moment over EI: that beyond the natural one [1/m], >= 0
};

/// One line of the history.
struct MotionSample {
  double time = 0.0;  ///< [s]
  std::vector<multibody::RigidBodyState> bodies;
  /// As Motion::contact_names counts them; of springs, pairs and contacts of bodies on the first of each.
  std::vector<ContactSample> contacts;
  /// Positions of the vertices, then of the wires that laws stand for [m].
  std::vector<Eigen::Matrix3Xd> wires;
  std::vector<Eigen::Vector3d> mount_forces;  ///< on the wire: left, right of each wire [N]
  std::vector<WireLoads> wire_loads;  ///< of the wires that are rods; empty without MotionOptions::wire_loads
  std::vector<double> law_tensions;   ///< of the wires that laws stand for [N]
  struct Arm {
    multibody::ArmState state;
    multibody::ArmWork work;
    Eigen::VectorXd joint_torque;  ///< of the springs with their dampers, on the motors [N m]
    Eigen::VectorXd drive_torque;  ///< of the drives on the motors [N m]
  };
  std::vector<Arm> arms;
  /// On the held bodies, about their centres of mass, axes of the world.
  std::vector<multibody::Wrench> welds;
  struct Bushing {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero(),
                    turn = Eigen::Vector3d::Zero();  ///< [m], [rad], axes of the first
    multibody::Wrench on_second;  ///< about its place on the second carrier, axes of the world
  };
  std::vector<Bushing> bushings;
  EnergyBalance energy;
  /// Of wires, free bodies and floating arms [kg m/s].
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< about the origin [kg m^2/s]
};

/// Tension of a wire, of a law or from the forces of its mounts on its ends: the smaller of their parts along
/// the edges there [N]; negative where they press.
[[nodiscard]] double end_tension(const Eigen::Matrix3Xd& positions, const Eigen::Vector3d& left,
                                 const Eigen::Vector3d& right);
[[nodiscard]] double end_tension(const MotionSample& sample, std::size_t wire);

/// What happened at a contact.
struct MotionEvent {
  enum class Kind { touch, lift_off, stick, slip };
  double time = 0.0;  ///< [s]
  int contact = 0;    ///< index as Motion::contact_names counts them
  int point = 0;      ///< of the contact
  double arc = 0.0;   ///< material coordinate [m]
  Kind kind = Kind::touch;
  double approach_speed = 0.0;  ///< before a touch; of the sliding at `stick` and `slip` [m/s]
};

/// "touch", "lift_off", "stick", "slip".
[[nodiscard]] std::string to_string(MotionEvent::Kind kind);

/// The beginning of a phase.
struct PhaseBeginning {
  int phase = 0;               ///< index
  double time = 0.0;           ///< [s]
  std::vector<double> angles;  ///< of the motors whose drives it changed [rad]
};

/// What a motion has summed up since its start.
struct MotionSums {
  std::vector<MotionEvent> events;
  std::vector<double> peak_force;        ///< of everything that presses: see PeakForce [N]
  std::vector<StrengthUse> strength;     ///< largest of every wire, at accepted steps
  std::vector<LeftOutInertia> left_out;  ///< of every wire; zero but of quasi-static ones
  std::vector<WireUse> wires;          ///< of every wire whose tightness is watched; the others' stay at zero
  std::vector<PhaseBeginning> phases;  ///< begun
  double largest_penetration = 0.0;    ///< into the foundations [m]
  double largest_drift = 0.0;          ///< of quaternions' length from one, and of rigid mounts [-], [m]
  double start_energy = 0.0;           ///< kinetic + strain + potential [J]
  Eigen::Vector3d start_momentum = Eigen::Vector3d::Zero();          ///< [kg m/s]
  Eigen::Vector3d start_angular_momentum = Eigen::Vector3d::Zero();  ///< about the origin [kg m^2/s]
  long samples = 0;                                                  ///< given to the observer
  numerics::IdaStatistics statistics;
  double wall_seconds = 0.0;  ///< [s]
  numerics::Effort effort;
};

/// All that a motion needs to go on from a time.
struct MotionState {
  double time = 0.0;  ///< [s]
  Eigen::VectorXd unknowns;
  Eigen::VectorXd rates;
  Eigen::VectorXd integrals;  ///< powers, reactions and contact forces over time
  /// Of the parts beside their unknowns: frames of the wires, states of the contacts.
  std::vector<double> memory;
  MotionSums sums;
};

/// What became of a motion: how it ended, what happened, its balances, and the state from which it can go on.
struct MotionResult {
  numerics::IdaReport report;  ///< `message` names time, step and the worst unknowns on failure
  std::vector<MotionEvent> events;
  EnergyBalance energy;
  /// Change of momentum less the impulse of all outer forces [N s].
  Eigen::Vector3d momentum_error = Eigen::Vector3d::Zero();
  /// The same about the origin, less that of all outer moments [N m s].
  Eigen::Vector3d angular_momentum_error = Eigen::Vector3d::Zero();
  std::vector<double> peak_force;     ///< of everything that presses: see PeakForce [N]
  std::vector<StrengthUse> strength;  ///< largest of every wire, at accepted steps; empty: no step was made
  std::vector<LeftOutInertia> left_out;  ///< of every wire; zero but of quasi-static ones
  std::vector<WireUse> wires;          ///< of every wire whose tightness is watched; the others' stay at zero
  std::vector<PhaseBeginning> phases;  ///< begun
  std::vector<Eigen::Vector3d> impulse;  ///< of what presses, on the wire or the first of two [N s]
  double largest_penetration = 0.0;      ///< into the foundations [m]
  double largest_drift = 0.0;            ///< of quaternions' length from one, and of rigid mounts [-], [m]
  numerics::IdaStatistics statistics;
  double wall_seconds = 0.0;
  MotionState last;  ///< to go on from; kept on failure too
};

/// Called at every output time, in order; true: stop.
using MotionObserver = std::function<bool(const MotionSample&)>;

}  // namespace snare::coupling
