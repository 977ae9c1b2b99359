#pragma once

#include "coupling/contact/mesh_file.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <numbers>
#include <string>
#include <vector>

namespace snare::test {

/// A cuboid about the origin.
[[nodiscard]] inline coupling::TriangleMesh cuboid(double a, double b, double c) {
  coupling::TriangleMesh m;
  m.name = "cuboid";
  for (int k = 0; k < 8; ++k)
    m.points.emplace_back((k & 1 ? 0.5 : -0.5) * a, (k & 2 ? 0.5 : -0.5) * b, (k & 4 ? 0.5 : -0.5) * c);
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

/// A profile (distance from the axis, height), from the axis to the axis, turned about z in `around` facets.
[[nodiscard]] inline coupling::TriangleMesh revolved_mesh(const std::vector<Eigen::Vector2d>& profile,
                                                          int around) {
  coupling::TriangleMesh m;
  m.name = "revolved";
  const auto rings = static_cast<int>(profile.size()) - 2;
  m.points.emplace_back(0.0, 0.0, profile.front().y());
  for (int k = 1; k <= rings; ++k) {
    for (int j = 0; j < around; ++j) {
      const double a = 2.0 * std::numbers::pi * j / around;
      const Eigen::Vector2d& p = profile[static_cast<std::size_t>(k)];
      m.points.emplace_back(p.x() * std::cos(a), p.x() * std::sin(a), p.y());
    }
  }
  m.points.emplace_back(0.0, 0.0, profile.back().y());
  const auto ring = [around](int k, int j) { return 1 + (k - 1) * around + j % around; };
  const int top = 1 + rings * around;
  for (int j = 0; j < around; ++j) {
    m.triangles.push_back({0, ring(1, j + 1), ring(1, j)});
    m.triangles.push_back({top, ring(rings, j), ring(rings, j + 1)});
    for (int k = 1; k < rings; ++k) {
      m.triangles.push_back({ring(k, j), ring(k, j + 1), ring(k + 1, j)});
      m.triangles.push_back({ring(k, j + 1), ring(k + 1, j + 1), ring(k + 1, j)});
    }
  }
  return m;
}

[[nodiscard]] inline std::vector<Eigen::Vector2d> half_circle(double radius, int pieces) {
  std::vector<Eigen::Vector2d> line;
  for (int k = 0; k <= pieces; ++k) {
    const double a = std::numbers::pi * (static_cast<double>(k) / pieces - 0.5);
    line.emplace_back(k == 0 || k == pieces ? 0.0 : radius * std::cos(a), radius * std::sin(a));
  }
  return line;
}

/// Writes a mesh by the file's ending (.stl, .obj, .off; "_binary.stl" a binary one), lengths divided by
/// `unit`.
inline void write_mesh(const std::filesystem::path& file, const coupling::TriangleMesh& mesh, double unit) {
  std::ofstream out(file, std::ios::binary);
  out << std::setprecision(17);
  const auto corner = [&](const std::array<int, 3>& t, std::size_t k) -> Eigen::Vector3d {
    return mesh.points[static_cast<std::size_t>(t[k])] / unit;
  };
  const std::string name = file.filename().string();
  if (name.ends_with("_binary.stl")) {
    std::string data(80, ' ');
    data.replace(0, 11, "solid maybe");
    const auto append = [&data](const auto& value) {
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      data.append(bytes, sizeof value);
    };
    append(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) append(0.0f);
      for (std::size_t k = 0; k < 3; ++k) {
        for (const double x : corner(t, k)) append(static_cast<float>(x));
      }
      append(static_cast<std::uint16_t>(0));
    }
    out << data;
  } else if (name.ends_with(".stl")) {
    out << "solid test\n";
    for (const auto& t : mesh.triangles) {
      out << "facet normal 0 0 0\n outer loop\n";
      for (std::size_t k = 0; k < 3; ++k) out << "  vertex " << corner(t, k).transpose() << '\n';
      out << " endloop\nendfacet\n";
    }
    out << "endsolid test\n";
  } else {
    const bool off = name.ends_with(".off");
    if (off) out << "OFF\n" << mesh.points.size() << ' ' << mesh.triangles.size() << " 0\n";
    for (const Eigen::Vector3d& p : mesh.points) out << (off ? "" : "v ") << (p / unit).transpose() << '\n';
    for (const auto& t : mesh.triangles) {
      if (off)
        out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
      else
        out << "f " << t[0] + 1 << "//1 " << t[1] + 1 << "//1 " << t[2] + 1 << "//1\n";
    }
  }
}

}  // namespace snare::test
