#pragma once

#include "base/toml_reader.hpp"
#include "scenario/world.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace snare::scenario {

/// What the first line of a scenario says whose file lists what there is.
inline constexpr std::string_view composed_schema = "snare-scenario/2";

/// Overrides of the files of arms, by the names of the arms.
using ArmOverrides = std::map<std::string, std::vector<base::Override>>;

/// Takes out of the overrides of a scenario those that go to the files of its arms:
/// `arms[NAME].joint.J1.coulomb_Nm`, where behind the name stands a key of the arm file (`joint`,
/// `every_joint`, `link` or `gravity_m_s2`).
[[nodiscard]] ArmOverrides take_arm_overrides(std::vector<base::Override>& overrides);

/// The mesh of the wires: as declared, or of half as many elements, from which the error of the mesh is
/// estimated.
enum class WireMesh { declared, halved };

/// Reads a scenario that lists what there is, with all files beside it in `folder`, and finishes the
/// document. One run.
///                                                                                      docs/scenario_file.md
[[nodiscard]] WireMotions read_composition(base::TomlDocument& document, const std::filesystem::path& folder,
                                           const ArmOverrides& arms = {}, WireMesh mesh = WireMesh::declared);

}  // namespace snare::scenario
