#pragma once

#include "multibody/arm/arm_file.hpp"
#include "scenario/arm_scenarios.hpp"
#include "base/toml_reader.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace snare::scenario {

/// A scenario of kind "joint_step", "tip_impulse" or "joint_motion".                        docs/scenario_file.md
struct ArmScenarioFile {
  std::string title, source, kind;
  multibody::ArmDescription description;
  multibody::ArmScenario scenario;
  int joint = -1;  ///< of a joint step
};

/// Angles of a pose of the arm, by name or one by one, from one of two keys; zeros after a problem.
[[nodiscard]] Eigen::VectorXd read_pose(const base::TomlTable& root, std::string_view name_key,
                                        std::string_view angles_key, const multibody::ArmDescription& arm);

/// Reads a scenario and the arm file that it names; throws InputError with everything that is wrong in it.
[[nodiscard]] ArmScenarioFile read_arm_scenario(const std::filesystem::path& file,
                                                const std::vector<base::Override>& overrides = {});

}  // namespace snare::scenario
