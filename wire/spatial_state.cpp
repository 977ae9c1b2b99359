#include "wire/spatial_state.hpp"

#include <cassert>
#include <cmath>

namespace snare::wire {

using Eigen::Vector3d;

void accept(SpatialState& state, const Eigen::VectorXd& q) {
  assert(q.size() == state.q.size());
  state.q = q;
  const std::size_t n = state.frames.size();
  // Frames to the new tangents (W.20); then the twists between them, each nearest to what it was (W.21).
  const double* near = state.q.data();
  for (std::size_t e = 0; e < n; ++e, near += SpatialState::block) {
    const double* far = near + SpatialState::block;
    Vector3d tangent(far[0] - near[0], far[1] - near[1], far[2] - near[2]);
    tangent *= 1.0 / std::sqrt(tangent.squaredNorm());
    state.frames[e] = transport(state.frames[e], tangent);
  }
  const auto update = [&state](std::size_t i, const Frame& before, const Frame& after) {
    state.reference_twist[i] = reference_twist(before, after, state.reference_twist[i]);
  };
  if (state.left_mount) update(0, *state.left_mount, state.frames.front());
  for (std::size_t i = 1; i < n; ++i) update(i, state.frames[i - 1], state.frames[i]);
  if (state.right_mount) update(n, state.frames.back(), *state.right_mount);
}

}  // namespace snare::wire
