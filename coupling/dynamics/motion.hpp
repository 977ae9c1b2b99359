#pragma once

#include "coupling/contact/contact_law.hpp"
#include "coupling/dynamics/arm.hpp"
#include "coupling/contact/friction.hpp"
#include "coupling/contact/shape.hpp"
#include "multibody/rigid_body.hpp"
#include "numerics/ida.hpp"
#include "wire/rod_dynamics.hpp"
#include "wire/specification.hpp"

#include <Eigen/Core>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace snare::coupling {

/// A wire in motion. The world frame is the wire's own: its mounts are given there.
struct MotionWire {
  std::string name = "wire";
  wire::RodInMotion rod;        ///< constants, mounts, damping and mesh
  Eigen::Matrix3Xd positions;   ///< of the vertices at the start [m]: see straight_wire, resting_wire
  Eigen::Matrix3Xd velocities;  ///< [m/s]; empty: at rest
};

/// A free rigid body.
struct MotionBody {
  std::string name = "body";
  multibody::RigidBodyProperties properties;
  multibody::RigidBodyState start;
  Eigen::Vector3d force =
      Eigen::Vector3d::Zero();  ///< constant, in the world frame, at the centre of mass [N]
  double linear_drag = 0.0;     ///< force -c v [N s/m], >= 0
  double angular_drag = 0.0;    ///< torque -c w [N m s/rad], >= 0
  /// Moved as prescribed instead of freely: constant start.velocity, or the course, and no rotation (a machine).
  bool driven = false;
  /// Of a driven body: velocity [m/s] at a time [s], continuous, and its derivative [m/s^2]. Both or none.
  std::function<Eigen::Vector3d(double time)> course_velocity, course_acceleration;
};

/// A shape that belongs to a body and may touch a wire, at several points at a time.
struct MotionContact {
  std::string name = "contact";
  int wire = 0;                                                  ///< index
  int body = 0;                                                  ///< index
  std::shared_ptr<const ContactShape> shape;                     ///< in a frame S fixed to the body
  Eigen::Vector3d shape_position = Eigen::Vector3d::Zero();      ///< p_BS [m]
  Eigen::Matrix3d shape_rotation = Eigen::Matrix3d::Identity();  ///< R_BS
  double wire_radius = 0.0;  ///< half the wire's diameter [m], >= 0; > 0 for a shape with edges
  int points = 4;            ///< most that are closed at a time, >= 1; more are a failure of the run
  MotionFriction friction;
  /// The papers' contact laws in place of the constraint: normal force [N] of penetration [m] and its rate [m/s], with
  /// the derivatives by both; never negative. Empty: the wire does not penetrate.
  ContactLaw law;
};

/// A contact law between a point of a body and a plane fixed in the world, which stands for a whole wire.
struct PointContactLaw {
  std::string name = "spring";
  int body = 0;                                            ///< index
  Eigen::Vector3d point = Eigen::Vector3d::Zero();         ///< p_BP, of the probe [m]
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();        ///< of the probe at first touch [m]
  double origin_speed = 0.0;                               ///< at which the plane moves along `direction` [m/s]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitY();    ///< of the push, unit
  ContactLaw law;                                          ///< of penetration along `direction` and its rate
};

struct Motion {
  std::vector<MotionWire> wires;
  std::vector<MotionBody> bodies;
  std::vector<MotionContact> contacts;
  std::vector<PointContactLaw> springs;
  std::vector<MotionArm> arms;
  std::vector<MotionWeld> welds;    ///< bodies on arms, on other bodies, on the world
  std::vector<MotionMount> mounts;  ///< ends of wires on arms or bodies; the others stand still
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

struct MotionOptions {
  double duration = 1.0;          ///< [s], > 0
  double output_interval = 1e-3;  ///< of the samples [s], > 0
  /// What a step may err by: the mean over a wire's vertices, over a body's components.        theory.md (M.12)
  double relative_tolerance = 1e-7;       ///< of everything: of coordinates too, wherever their origin is [-]
  double position_tolerance = 1e-8;       ///< of wires [m]
  double velocity_tolerance = 1e-4;       ///< of wires [m/s]
  double twist_tolerance = 1e-7;          ///< of wires [rad]
  double body_position_tolerance = 1e-9;  ///< [m]
  double body_velocity_tolerance = 1e-6;  ///< [m/s]
  double angle_tolerance = 1e-9;          ///< of bodies' quaternions [rad]
  double spin_tolerance = 1e-5;           ///< of bodies [rad/s]
  double force_tolerance = 1e-2;     ///< [N], of multipliers: for the Newton iteration only
  int max_order = 2;                 ///< of IDA: see theory.md (M.2)
  double newton_share = 0.003;       ///< of these tolerances that Newton's method may leave at a step, in (0, 1)
  double max_step = std::numeric_limits<double>::infinity();  ///< [s]; no touch is missed without one
  int max_events = 100000;                                    ///< more are a failure
  /// At every multiple of this the integration begins anew at first order from what a MotionState holds, so that going on
  /// from there gives the same bits as having gone through [s], > 0.
  double checkpoint_interval = std::numeric_limits<double>::infinity();
  std::function<bool()> stop;  ///< asked after every step; true: stop. The observer is asked at output times only
};

/// What a contact does at one time.
struct ContactSample {
  bool closed = false;
  double gap = 0.0;                                 ///< [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on the wire, world frame [N]
  double normal_force = 0.0;                        ///< [N], >= 0
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the wire's centreline [m]
  double arc = 0.0;                                 ///< material coordinate [m]
  double slip_speed = 0.0;                          ///< [m/s]
  bool sticking = false;                            ///< closed, with a bristle that does not slide
  /// Of a shape on a wire: its closed points, the one that presses most first. Then the forces above are their sums, gap and place those
  /// of the first, or of the wire's nearest point while all are open.
  std::vector<ContactSample> points;
};

/// Energies [J] of all wires, free bodies and arms.
struct EnergyBalance {
  double kinetic = 0.0;
  double strain = 0.0;  ///< of the wires, and of bristles
  double potential = 0.0;
  double dissipated = 0.0;  ///< by damping, drag, friction, contact laws and joints, integrated along the run
  double impacts = 0.0;     ///< lost when local masses of the wire take on a body's velocity at once
  double work = 0.0;        ///< done by driven bodies, constant forces, drives and loads of arms
  /// kinetic + strain + potential + dissipated + impacts - work - the same at the start: what the integrator gained
  /// (negative: lost).
  double integrator = 0.0;
};

/// One line of the history.
struct MotionSample {
  double time = 0.0;
  std::vector<multibody::RigidBodyState> bodies;
  std::vector<ContactSample> contacts;       ///< then the springs
  std::vector<Eigen::Matrix3Xd> wires;        ///< positions of the vertices [m]
  std::vector<Eigen::Vector3d> mount_forces;  ///< on the wire: left, right of each wire [N]
  struct Arm {
    multibody::ArmState state;
    multibody::ArmWork work;
    Eigen::VectorXd joint_torque;  ///< of the springs with their dampers, on the motors [N m]
  };
  std::vector<Arm> arms;
  std::vector<multibody::Wrench> welds;  ///< on the held bodies, about their centres of mass, axes of the world
  EnergyBalance energy;
  /// Of wires, free bodies and floating arms [kg m/s].
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< about the origin [kg m^2/s]
};

/// What happened at a contact.
struct MotionEvent {
  /// A touch begins in the stick; where it slides at once, `slip` follows at the same time.
  enum class Kind { touch, lift_off, stick, slip };
  double time = 0.0;
  int contact = 0;  ///< index; springs count on after the contacts
  int point = 0;    ///< of the contact
  double arc = 0.0;  ///< material coordinate [m]
  Kind kind = Kind::touch;
  double approach_speed = 0.0;  ///< before a touch; of the sliding at `stick` and `slip` [m/s]
};

/// "touch", "lift_off", "stick", "slip".
[[nodiscard]] std::string to_string(MotionEvent::Kind kind);
/// What a motion has summed up since its start.
struct MotionSums {
  std::vector<MotionEvent> events;
  std::vector<double> peak_force;    ///< of every contact and spring, at accepted steps [N]
  double largest_penetration = 0.0;  ///< of closed contacts without law [m]
  double largest_gap = 0.0;          ///< of the same, to either side: what the constraint drifts [m]
  double largest_drift = 0.0;        ///< of quaternions' length from one, and of rigid mounts [-], [m]
  double impacts = 0.0;              ///< energy lost at touches [J]
  double start_energy = 0.0;         ///< kinetic + strain + potential [J]
  Eigen::Vector3d start_momentum = Eigen::Vector3d::Zero();          ///< [kg m/s]
  Eigen::Vector3d start_angular_momentum = Eigen::Vector3d::Zero();  ///< about the origin [kg m^2/s]
  long samples = 0;                                                  ///< given to the observer
  numerics::IdaStatistics statistics;
  double wall_seconds = 0.0;
  double search_seconds = 0.0;
};

/// All that a motion needs to go on from a time.
struct MotionState {
  double time = 0.0;
  Eigen::VectorXd unknowns;
  Eigen::VectorXd rates;
  Eigen::VectorXd integrals;   ///< powers, reactions and contact forces over time
  std::vector<double> memory;  ///< of the parts beside their unknowns: frames of the wires, states of the contacts
  MotionSums sums;
};

struct MotionResult {
  numerics::IdaReport report;  ///< `message` names time, step and the worst unknowns on failure
  std::vector<MotionEvent> events;
  EnergyBalance energy;
  Eigen::Vector3d momentum_error =
      Eigen::Vector3d::Zero();           ///< change less the impulse of all outer forces [N s]
  Eigen::Vector3d angular_momentum_error =
      Eigen::Vector3d::Zero();           ///< about the origin: change less that of all outer moments [N m s]
  std::vector<double> peak_force;        ///< of every contact and spring, at accepted steps [N]
  std::vector<Eigen::Vector3d> impulse;  ///< of every contact on its wire, of every body on its spring [N s]
  double largest_penetration = 0.0;      ///< of closed contacts without law [m]
  double largest_gap = 0.0;              ///< of the same, to either side: what the constraint drifts [m]
  double largest_drift = 0.0;            ///< of quaternions' length from one, and of rigid mounts [-], [m]
  numerics::IdaStatistics statistics;
  double wall_seconds = 0.0;
  double search_seconds = 0.0;  ///< of them, in finding touches
  MotionState last;  ///< to go on from; kept on failure too
};

/// Called at every output time, in order; true: stop.
using MotionObserver = std::function<bool(const MotionSample&)>;

/// Called at every checkpoint, with what to go on from.
using MotionKeeper = std::function<void(const MotionState&)>;

/// A naturally straight wire of a specification (with its strands' friction) between clamps at the origin and at (span, 0, 0) [m].
[[nodiscard]] wire::RodInMotion rod_in_motion(const wire::WireSpecification& specification, double span, int elements);

/// Vertices evenly spread between the mounts' positions (or from `from` to `to`).
[[nodiscard]] Eigen::Matrix3Xd straight_wire(const wire::RodInMotion& rod, const Eigen::Vector3d& from,
                                             const Eigen::Vector3d& to);

/// The wire at rest between its mounts, buckled to +y in its first mode where it is longer than their distance.
/// Throws InputError when no equilibrium is found.
[[nodiscard]] Eigen::Matrix3Xd resting_wire(const wire::RodInMotion& rod);

/// Integrates a motion.                                                     theory.md (M.1)-(M.17)
/// Wrong numbers throw InputError with all of them. A failure of the integration is in `report`; the rest is
/// what was reached.
/// from: go on from there instead of from the start; of the same motion (other forces and courses of its bodies are
/// allowed). Sums, events and samples go on too. From a checkpoint the result has the same bits as without the stop.
[[nodiscard]] MotionResult simulate(const Motion& motion, const MotionOptions& options,
                                    const MotionObserver& observer = {}, const MotionState* from = nullptr,
                                    const MotionKeeper& keeper = {});

}  // namespace snare::coupling
