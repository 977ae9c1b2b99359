#pragma once

#include "base/toml_reader.hpp"
#include "multibody/arm/arm_file.hpp"

#include <string_view>

namespace snare::scenario {

/// Angles of a pose of the arm [rad], by name or one by one, from one of two keys; zeros after a problem.
[[nodiscard]] Eigen::VectorXd read_pose(const base::TomlTable& root, std::string_view name_key,
                                        std::string_view angles_key, const multibody::ArmDescription& arm);

}  // namespace snare::scenario
