#pragma once

#include "base/errors.hpp"
#include "multibody/tree.hpp"

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snare::multibody {

/// A link of a robot description.
struct RobotLink {
  std::string name;
  SpatialInertia inertia;  ///< in the link's frame; nothing for a link that only names a frame
};

/// A joint; the child's frame is the joint's at zero.
struct RobotJoint {
  std::string name, parent, child;
  std::optional<JointKind> kind;  ///< none: fixed
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  Pose X_PJ;
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad, m]
  double upper = std::numeric_limits<double>::infinity();
  double effort = std::numeric_limits<double>::infinity();  ///< [N m, N]
  double speed = std::numeric_limits<double>::infinity();   ///< [rad/s, m/s]
  double damping = 0.0;                                     ///< of <dynamics> [N m s/rad, N s/m], >= 0
  double friction = 0.0;                                    ///< of <dynamics>, dry [N m, N], >= 0
};

/// A tree of links as told by a URDF file.
struct RobotDescription {
  std::string text;  ///< of the URDF
  std::string name, root;
  std::vector<RobotLink> links;    ///< parents before children, the root first
  std::vector<RobotJoint> joints;  ///< joint i carries link i + 1
  /// About numbers that are legal and more likely in another unit: moments of inertia beyond the robot's
  /// size, limits beyond a turn.
  std::vector<std::string> warnings = {};
};

/// Reads a URDF file, SI units as URDF has them. Throws InputError with everything that is wrong: names,
/// numbers, inertias that no body has, links that nothing carries, loops. docs/arm_files.md lists what is
/// checked.
[[nodiscard]] RobotDescription read_urdf(const std::filesystem::path& file);
/// The same from text in memory; `file` stands in messages.
[[nodiscard]] RobotDescription parse_urdf(const std::string& file, const std::string& text);

/// What is wrong with the text, in the order of the lines. Empty: urdfdom may read it.
[[nodiscard]] std::vector<base::InputProblem> check_urdf(const std::string& file, const std::string& text);

/// How the root link is joined to the frame that it is put on.
enum class RootJoint { fixed, free };

/// Adds the robot to a tree, its root link's frame on the given frame. Names in the tree are those of the
/// links.
/// Throws std::invalid_argument for a name that the tree has already.
void add_robot(Tree& tree, int frame, RootJoint root, const RobotDescription& robot);

}  // namespace snare::multibody
