#pragma once

#include "base/toml_reader.hpp"
#include "coupling/contact/shape.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace snare::scenario {

/// The shape that a table of `[[shapes]]` describes by its `kind`: docs/scenario_file.md. Nothing when it is
/// wrong, which is reported.
/// folder: where files of meshes are. meshes: what stands for their content is added.
[[nodiscard]] std::shared_ptr<const coupling::ContactShape> read_shape(const base::TomlTable& table,
                                                                       const std::filesystem::path& folder,
                                                                       std::string& meshes);

/// A straight round piece of a shape, which wires meet that laws stand for: on z about a height in the
/// shape's frame.
struct ShaftSize {
  double radius = 0.0, half_length = 0.0, height = 0.0;  ///< [m]
};
/// Of a capsule, a knife edge, a cylinder and a grapple shaft; nothing of any other kind.
[[nodiscard]] std::optional<ShaftSize> read_shaft_size(const base::TomlTable& table);

/// Points with which a shape touches other bodies, in its frame: its ends and the corners of its section,
/// each all round by `rim_points`; a ball's and a capsule's are balls.
struct ShapePoints {
  std::vector<Eigen::Vector3d> points;  ///< [m]; none: of a plane
  double radius = 0.0;                  ///< [m]
};
[[nodiscard]] ShapePoints read_shape_points(const base::TomlTable& table,
                                            const std::filesystem::path& folder);

}  // namespace snare::scenario
