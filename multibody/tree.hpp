#pragma once

#include "multibody/spatial.hpp"

#include <Eigen/Core>

#include <string>
#include <string_view>
#include <vector>

namespace snare::multibody {

/// How a moving body is joined to its parent.
///
/// A free joint has the coordinates p (3) [m] and a quaternion w, x, y, z (4) of the pose of the body in the
/// joint's frame, and the velocities omega (3) [rad/s] and v (3) [m/s] of the body in its own axes.
///                                                                                            theory.md (A.3)
enum class JointKind { revolute, prismatic, free };

/// A moving body and the joint that carries it. At zero of a revolute or prismatic joint the body's frame is
/// the joint's.
struct TreeBody {
  std::string name;
  int parent = -1;  ///< index of the body that carries it; -1: the world
  JointKind joint = JointKind::revolute;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, in the joint's frame; unused by a free joint
  Pose X_PJ;                                        ///< pose of the joint's frame in the parent's frame
  SpatialInertia inertia;                           ///< in the body's frame, with all that is fixed to it
  int q_index = 0;                                  ///< first coordinate
  int v_index = 0;                                  ///< first velocity

  /// Entries of q that are this joint's, from q_index on.
  [[nodiscard]] int coordinates() const { return joint == JointKind::free ? 7 : 1; }
  /// Entries of v that are this joint's, from v_index on.
  [[nodiscard]] int velocities() const { return joint == JointKind::free ? 6 : 1; }
};

/// A named frame fixed to a body (or to the world).
struct TreeFrame {
  std::string name;
  int body = -1;  ///< -1: the world
  Pose X_BF;
};

/// Rigid bodies in an open tree: constants only. Parents come before children.
///
/// What a fixed joint holds becomes part of the body that carries it: its inertia is added and its frame is
/// kept by name. Every body's frame is also a named frame. Frame 0 is the world, called "world".
class Tree {
 public:
  Tree();

  /// Adds a body on a joint whose frame has the pose X_FJ in an existing frame; the axis is made a unit
  /// vector. Returns the index of the body's frame. Throws std::invalid_argument for a name that is taken, or
  /// no axis.
  int add_moving(int frame, const std::string& name, JointKind joint, const Eigen::Vector3d& axis,
                 const Pose& X_FJ, const SpatialInertia& inertia);
  /// Adds a body that is fixed in an existing frame; returns the index of its own frame. On the world its
  /// mass is nothing.
  int add_fixed(int frame, const std::string& name, const Pose& X_FB, const SpatialInertia& inertia = {});

  /// Moves the whole to another place: all that stands in the world frame W stands in a frame of the pose
  /// X_VW in the new world V. Gravity stays as it is.
  void move(const Pose& X_VW);

  /// Moving bodies, every one behind its parent; the world is none of them.
  [[nodiscard]] const std::vector<TreeBody>& bodies() const { return bodies_; }
  /// Body i, 0 <= i < size().
  [[nodiscard]] const TreeBody& body(int i) const { return bodies_[static_cast<std::size_t>(i)]; }
  /// Named frames, the world's first.
  [[nodiscard]] const std::vector<TreeFrame>& frames() const { return frames_; }
  /// Frame i, as `find_frame` counts it.
  [[nodiscard]] const TreeFrame& frame(int i) const { return frames_[static_cast<std::size_t>(i)]; }
  /// Index of a frame, or -1.
  [[nodiscard]] int find_frame(std::string_view name) const;
  [[nodiscard]] int size() const { return static_cast<int>(bodies_.size()); }
  [[nodiscard]] int coordinates() const { return coordinates_; }  ///< length of q
  [[nodiscard]] int velocities() const { return velocities_; }    ///< length of v

  /// Mass of all moving bodies [kg].
  [[nodiscard]] double mass() const;

  /// Field of gravity [m/s^2], in the world. Zero in orbit.
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();

 private:
  std::vector<TreeBody> bodies_;
  std::vector<TreeFrame> frames_;
  int coordinates_ = 0;
  int velocities_ = 0;
};

/// Coordinates and velocities of a tree.
struct TreeState {
  Eigen::VectorXd q;  ///< (tree.coordinates()) [rad, m, -]
  Eigen::VectorXd v;  ///< (tree.velocities()) [rad/s, m/s]
};

/// At rest in the pose where every joint is at zero.
[[nodiscard]] TreeState zero_state(const Tree& tree);

/// Pose of the body in its joint's frame at q, (nq) [rad, m, -].
[[nodiscard]] Pose joint_pose(const TreeBody& body, const Eigen::VectorXd& q);

/// Rate of the coordinates of a body on a free joint, (7) [m/s, 1/s], with the unit quaternion's rate 1/2
/// quat * (0, omega).
///                                                                                            theory.md (A.3)
[[nodiscard]] Eigen::Matrix<double, 7, 1> free_coordinate_rate(const TreeBody& body, const Eigen::VectorXd& q,
                                                               const Eigen::VectorXd& v);

}  // namespace snare::multibody
