#pragma once

#include "wire/frames.hpp"
#include "wire/mesh.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace snare::wire {

/// Unknowns of the spatial rod, q = (x_0, y_0, z_0, theta_0, x_1, ...) [m, rad] with theta_i of the edge that
/// starts at vertex i (the last one is unused), what carries the mesh, and the time-parallel frames.
///
/// Change q through `accept` or `advance` only: they carry the frames along.
struct SpatialState {
  static constexpr int block = 4;  ///< unknowns a vertex: x, y, z, theta
  static constexpr int angle = 3;  ///< place of theta among them

  Eigen::VectorXd q;
  Controls controls{};
  std::vector<Frame> frames;        ///< reference frames of the edges
  std::optional<Frame> left_mount;  ///< of a mount that orients
  std::optional<Frame> right_mount;
  std::vector<double> reference_twist;  ///< m of every vertex [rad]
};

/// Sets the unknowns [m, rad] and carries the reference frames to the new tangents; the reference twist
/// follows without jumps while it changes by less than pi a step at every vertex.
void accept(SpatialState& state, const Eigen::VectorXd& q);

/// Adds a step [m, rad] to the unknowns.
inline void advance(SpatialState& state, const Eigen::VectorXd& step) {
  accept(state, state.q + step);
}

/// Position of vertex i [m].
[[nodiscard]] inline Eigen::Vector3d vertex(const SpatialState& state, int i) {
  return state.q.segment<3>(SpatialState::block * i);
}

}  // namespace snare::wire
