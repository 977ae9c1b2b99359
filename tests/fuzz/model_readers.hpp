#pragma once

#include "base/archive.hpp"
#include "base/errors.hpp"
#include "coupling/contact/mesh_file.hpp"
#include "multibody/urdf.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace snare::fuzz {

/// Gives arbitrary bytes to the reader of robot descriptions. It must return what is whole or throw
/// InputError; whatever else leaves here is a defect. Whether it was accepted.
inline bool read_bytes_as_urdf(std::string_view bytes) {
  try {
    const multibody::RobotDescription robot = multibody::parse_urdf("fuzz.urdf", std::string(bytes));
    if (robot.links.size() != robot.joints.size() + 1)
      throw std::logic_error("links and joints form no tree");
    return true;
  } catch (const base::InputError& error) {
    if (error.problems().empty()) throw std::logic_error("an error without a problem");
    return false;
  }
}

/// The same for triangle meshes; `ending` says which format: ".stl", ".obj", ".off".
inline bool read_bytes_as_mesh(std::string_view bytes, const char* ending) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("snare_fuzz_" + std::to_string(::getpid()) + ending);
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr) return false;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
  std::fclose(stream);
  bool accepted = false;
  try {
    const coupling::TriangleMesh mesh = coupling::read_triangle_mesh(file, 1e-3);
    for (const Eigen::Vector3d& p : mesh.points)
      if (!p.allFinite()) throw std::logic_error("a point that is not finite was read");
    for (const auto& triangle : mesh.triangles) {
      for (const int corner : triangle)
        if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.points.size())
          throw std::logic_error("a corner that is no point was read");
    }
    accepted = written;
  } catch (const base::InputError& error) {
    if (error.problems().empty()) throw std::logic_error("an error without a problem");
  }
  std::filesystem::remove(file);
  return accepted;
}

/// The same for what a checkpoint is made of: texts, lists of lists, matrices. A size that cannot be must not
/// be reserved.
inline bool read_bytes_as_archive(std::string_view bytes) {
  try {
    std::string text;
    std::vector<std::vector<std::string>> lists;
    std::vector<Eigen::Matrix3Xd> shapes;
    Eigen::VectorXd numbers;
    base::ByteReader reader(bytes);
    reader(text)(lists)(shapes)(numbers);
    return reader.at_end();
  } catch (const std::runtime_error&) {
    return false;
  }
}

}  // namespace snare::fuzz
