#pragma once

#include "base/toml_reader.hpp"
#include "multibody/arm/arm_file.hpp"
#include "scenario/world.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace snare::scenario {

/// The arm of the file under the key `arm`, sought in `folder`; nothing after a problem, which the document is told.
[[nodiscard]] std::optional<multibody::ArmDescription> read_arm_beside(base::TomlDocument& document,
                                                                       const std::filesystem::path& folder);

/// Angles of a pose of the arm [rad], by name or one by one, from one of two keys; zeros after a problem.
[[nodiscard]] Eigen::VectorXd read_pose(const base::TomlTable& root, std::string_view name_key,
                                        std::string_view angles_key, const multibody::ArmDescription& arm);

/// Reads what is particular to a scenario of kind "joint_step", "tip_impulse" or "joint_motion", the arm file in `folder`
/// too, and finishes the document.
[[nodiscard]] ArmMotion read_arm_motion(base::TomlDocument& document, const std::filesystem::path& folder);

}  // namespace snare::scenario
