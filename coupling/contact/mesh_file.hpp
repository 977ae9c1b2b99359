#pragma once

#include <Eigen/Core>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace snare::coupling {

/// Triangles with shared corners.
struct TriangleMesh {
  std::string name;                           ///< the file, for messages; may be empty
  std::vector<Eigen::Vector3d> points;        ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< indices of points, counterclockwise seen from outside
};

/// Reads the triangles of a mesh file: STL (ascii or binary, .stl), Wavefront OBJ (.obj) or OFF (.off).
/// Polygons are cut into fans. Points of an STL that agree to the last bit are one.
///
/// unit: of the file's lengths [m], 1e-3 for millimetres. Throws InputError that names file, line (binary:
/// triangle) and value: unreadable, another format, not a finite number, an index of no point, no triangle.
/// What the triangles bound is not looked at: see MeshShape.
[[nodiscard]] TriangleMesh read_triangle_mesh(const std::filesystem::path& file, double unit);

}  // namespace snare::coupling
