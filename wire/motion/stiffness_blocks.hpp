#pragma once

namespace snare::wire::stiffness {

/// Rows of blocks, those of an edge's vector and angle being 0 to 3 of each: by places of the edge itself, of
/// the next by it and of it by the next; by rates of the vectors alone; by the curvatures at its two ends; a
/// vertex's curvatures by themselves and by the next ones.
inline constexpr int of_angle = 3;
enum Block : int {  // first rows
  own_place = 0,
  next_place = own_place + 16,   // D_{e,e+1}
  last_place = next_place + 16,  // D_{e+1,e}
  own_rate = last_place + 16,
  next_rate = own_rate + 12,
  last_rate = next_rate + 12,
  near_curvature = last_rate + 12,  // of an edge by the curvatures of its first vertex
  far_curvature = near_curvature + 8,
  curvature = far_curvature + 8,  // of a vertex's curvatures
  next_curvature = curvature + 4,
  blocks = next_curvature + 4
};
/// Row of an entry (r, s) of a block that begins at row `first`; columns of four.
[[nodiscard]] constexpr int entry(int first, int r, int s) {
  return first + 4 * s + r;
}
/// The same of curvatures by curvatures, columns of two.
[[nodiscard]] constexpr int entry_of_two(int first, int r, int s) {
  return first + 2 * s + r;
}

}  // namespace snare::wire::stiffness
