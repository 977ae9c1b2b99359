#pragma once

#include "multibody/arm/deflection_law.hpp"
#include "multibody/arm/drive.hpp"
#include "multibody/arm/joint_friction.hpp"
#include "multibody/kinematics.hpp"
#include "multibody/tree.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace snare::multibody {

/// A motor that turns a joint through an elastic gear; all of it on the output side.          theory.md (A.9)
struct ElasticJoint {
  std::string name;
  std::string
      link{};    ///< that it moves; of one that bends it carries a part, which has another name in the tree
  int body = 0;  ///< of the tree, on a revolute or prismatic joint
  double motor_inertia = 0.0;  ///< B = (gear ratio)^2 times that of the rotor [kg m^2], > 0
  DeflectionLaw spring = DeflectionLaw::linear(0.0, 0.0);
  JointFriction friction;
  double back_drive = 0.0;  ///< added to the dry friction while limp [N m], >= 0
  bool flexure = false;     ///< a link that bends: the motor stands for what holds the hinge, and never moves
};

/// A manipulator whose joints are elastic, in the two-mass form of Spong 1987. Constants only.
///                                                                                            theory.md (A.9)
///
///   H(q) q'' + c(q, q') + T(q - qm, .) = J^T F         B qm'' + D qm' + friction - T = tau
/// Joints without an entry swing freely (a free base among them). The turning of the rotors with the links is
/// left out, as
/// there: the inertia of a rotor counts against its own link only.
struct ElasticArm {
  Tree tree;
  std::vector<ElasticJoint> joints;

  /// Motors there are, one an elastic joint.
  [[nodiscard]] int motors() const { return static_cast<int>(joints.size()); }
};

/// Coordinates of links and motors, and their rates.
struct ArmState {
  Eigen::VectorXd q, v;               ///< of the tree
  Eigen::VectorXd motor, motor_rate;  ///< qm [rad], qm' [rad/s]
};

/// At rest in the pose q, (tree.coordinates()) [rad, m, -], springs relaxed.
[[nodiscard]] ArmState resting(const ElasticArm& arm, const Eigen::VectorXd& q);

/// q - qm of a joint [rad], its rate [rad/s].
[[nodiscard]] double deflection(const ElasticArm& arm, const ArmState& state, int joint);

/// Kinetic energy of links and rotors, potential energy, energy in the springs [J].
[[nodiscard]] double total_energy(const ElasticArm& arm, const ArmState& state);

/// Undamped natural frequencies about a pose at rest.
struct ArmMode {
  double frequency = 0.0;  ///< [Hz]
  Eigen::VectorXd shape;   ///< of (v, qm), H-normal
};

/// Modes with the springs' stiffness at the given deflections (0: the law's first piece), without damping,
/// friction and
/// velocities:  (K - (2 pi f)^2 M) x = 0, M = diag(H, B), of the free and servo-held motors.
///                                                                                           theory.md (A.13)
/// Modes of no stiffness come out with frequency 0. Ascending. Motors that are locked do not take part. q
/// [rad, m, -], deflections [rad].
[[nodiscard]] std::vector<ArmMode> natural_modes(const ElasticArm& arm, const Eigen::VectorXd& q,
                                                 const std::vector<Drive>& drives,
                                                 const Eigen::VectorXd& deflections = {});

}  // namespace snare::multibody
