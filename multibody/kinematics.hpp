#pragma once

#include "multibody/tree.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::multibody {

using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Poses and velocities of all bodies. Storage is made once; `place` and `set_moving` allocate nothing.
struct Kinematics {
  explicit Kinematics(const Tree& tree);

  std::vector<Pose> X_PB;  ///< of each body in its parent
  std::vector<Pose> X_WB;  ///< of each body in the world
  std::vector<Twist> V_B;  ///< velocity of each body, in its own frame
};

/// Adds the velocity of a body against its joint's frame, in its own axes.                    theory.md (A.3)
/// v: (nv) [rad/s, m/s].
inline void add_joint_motion(const TreeBody& body, const Eigen::VectorXd& v, Twist& V) {
  switch (body.joint) {
    case JointKind::revolute:
      V.angular += v[body.v_index] * body.axis;
      break;
    case JointKind::prismatic:
      V.linear += v[body.v_index] * body.axis;
      break;
    case JointKind::free:
      V.angular += v.segment<3>(body.v_index);
      V.linear += v.segment<3>(body.v_index + 3);
      break;
  }
}

/// Poses for the coordinates q, (nq) [rad, m, -].
void place(const Tree& tree, const Eigen::VectorXd& q, Kinematics& kinematics);
/// Velocities for v, (nv) [rad/s, m/s], after `place`.
void set_moving(const Tree& tree, const Eigen::VectorXd& v, Kinematics& kinematics);

/// Pose of a frame in the world.
[[nodiscard]] Pose frame_pose(const Tree& tree, const Kinematics& kinematics, int frame);

/// Motion of a frame: angular velocity [rad/s] and velocity of its origin [m/s], in the axes of the world.
struct FrameMotion {
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
};
[[nodiscard]] FrameMotion frame_motion(const Tree& tree, const Kinematics& kinematics, int frame);

/// Jacobian J(q) of a frame, (6 x nv): angular velocity over velocity of the origin, in the axes of the
/// world, for each velocity [-, m].                                                           theory.md (A.4)
[[nodiscard]] Matrix6X frame_jacobian(const Tree& tree, const Kinematics& kinematics, int frame);
/// J^T F of a wrench about a point p_W [m] of a body, in the axes of the world [N m, N]: added to forces
/// (nv).
void add_force(const Tree& tree, const Kinematics& kinematics, int body, const Eigen::Vector3d& p_W,
               const Wrench& F_W, Eigen::Ref<Eigen::VectorXd> forces);
/// The Jacobian of a point p_W [m] of a body.
[[nodiscard]] Matrix6X point_jacobian(const Tree& tree, const Kinematics& kinematics, int body,
                                      const Eigen::Vector3d& p_W);
/// Its rate dJ/dt along the motion in `kinematics`, (6 x nv) [1/s, m/s].
[[nodiscard]] Matrix6X frame_jacobian_rate(const Tree& tree, const Kinematics& kinematics, int frame);

/// Kinetic energy [J].
[[nodiscard]] double kinetic_energy(const Tree& tree, const Kinematics& kinematics);
/// Potential energy in the field of gravity, zero for a mass at the world's origin [J].
[[nodiscard]] double potential_energy(const Tree& tree, const Kinematics& kinematics);
/// Momentum of all bodies: angular about the origin of the world [N m s], linear [N s], in its axes.
[[nodiscard]] Wrench momentum(const Tree& tree, const Kinematics& kinematics);
/// Centre of mass of all moving bodies in the world [m].
[[nodiscard]] Eigen::Vector3d centre_of_mass(const Tree& tree, const Kinematics& kinematics);

/// A wrench on a frame, as the wrench on the body that carries it, in the body's frame: what the dynamics
/// take.
struct BodyWrench {
  int body = -1;
  Wrench F_B;
};
/// F_F: moment about the frame's origin and force, in the frame's axes.
[[nodiscard]] BodyWrench wrench_on_frame(const Tree& tree, int frame, const Wrench& F_F);
/// The same given in the axes of the world.
[[nodiscard]] BodyWrench world_wrench_on_frame(const Tree& tree, const Kinematics& kinematics, int frame,
                                               const Wrench& F_W);

}  // namespace snare::multibody
