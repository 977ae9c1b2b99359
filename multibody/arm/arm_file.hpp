#pragma once

#include "base/toml_tree.hpp"
#include "multibody/arm/elastic_arm.hpp"
#include "multibody/urdf.hpp"

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <vector>

namespace snare::multibody {

/// A pose with a name.
struct ArmPose {
  std::string name;
  Eigen::VectorXd angles;  ///< of the elastic joints [rad]
};

/// An arm as its file tells it: URDF for the bodies, TOML for what URDF cannot say.
/// docs/arm_files.md
struct ArmDescription {
  std::string title, source;
  std::filesystem::path file;
  std::string input;  ///< canonical text of everything that was read: equal for equal arms
  ElasticArm arm;
  /// The moving joints: of the first elastic joints, behind which those of bending links come.
  std::vector<RobotJoint> joints;
  std::vector<Drive> drives;  ///< of all elastic joints, at rest, held where they are
  std::vector<ArmPose> poses;
  int tip = 0;                             ///< frame
  double arm_mass = 0.0;                   ///< of the arm's own URDF [kg]
  std::vector<std::string> warnings = {};  ///< see RobotDescription, of all files that it names

  /// Angles of the moving joints with those of the flexures, which are zero, behind them [rad].
  [[nodiscard]] Eigen::VectorXd with_flexures(const Eigen::VectorXd& angles) const;
  /// Coordinates (tree.coordinates()) [rad, m, -] with the elastic joints at the given angles [rad]; a free
  /// base at the origin.
  [[nodiscard]] Eigen::VectorXd coordinates(const Eigen::VectorXd& angles) const;
};

/// Reads an arm file. Throws InputError with everything that is wrong in it or in the URDF files it names.
[[nodiscard]] ArmDescription read_arm(const std::filesystem::path& file,
                                      const std::vector<base::Override>& overrides = {});
/// The same from text in memory; `file` stands in messages and other files are looked for beside it.
[[nodiscard]] ArmDescription parse_arm(const std::filesystem::path& file, const std::string& text,
                                       const std::vector<base::Override>& overrides = {});

/// Length of the longest straight line from the first moving joint of the arm to the tip: the sum of the
/// offsets [m].
[[nodiscard]] double reach(const ArmDescription& description);

}  // namespace snare::multibody
