#pragma once

#include "base/toml_reader.hpp"
#include "coupling/contact/shape.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace snare::scenario {

/// The shape that a table of `[[shapes]]` describes by its `kind`: docs/scenario_file.md. Nothing when it is wrong, which is reported.
/// folder: where files of meshes are. meshes: what stands for their content is added.
[[nodiscard]] std::shared_ptr<const coupling::ContactShape> read_shape(const base::TomlTable& table,
                                                                       const std::filesystem::path& folder,
                                                                       std::string& meshes);

}  // namespace snare::scenario
