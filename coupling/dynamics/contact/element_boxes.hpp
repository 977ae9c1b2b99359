#pragma once

#include "coupling/dynamics/contact/bezier_wire.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace snare::coupling {

/// Boxes around the elements of a wire, by twos in boxes around more of them: a binary tree, refitted where
/// the wire moves.
///                                                                                            theory.md (G.6)
class ElementBoxes {
 public:
  ElementBoxes() = default;
  explicit ElementBoxes(int elements);
  /// Boxes of the control points [m] at unknowns y of the run (SI units).
  void place(const BezierWire& curve, const numerics::VectorView& y);

  static constexpr std::size_t root = 1;
  /// Whether a node of the tree stands for one element, and for which.
  [[nodiscard]] bool is_element(std::size_t node) const { return node >= leaves_; }
  [[nodiscard]] int element(std::size_t node) const { return static_cast<int>(node - leaves_); }
  /// Whether it has elements at all: the tree is filled up to a power of two.
  [[nodiscard]] bool is_empty(std::size_t node) const { return boxes_[node].isEmpty(); }
  /// What the node's elements lie in, axes of the world [m]; empty for places that only fill the tree up.
  [[nodiscard]] const Eigen::AlignedBox3d& box(std::size_t node) const { return boxes_[node]; }
  [[nodiscard]] static std::size_t child(std::size_t node, std::size_t k) { return 2 * node + k; }

 private:
  std::size_t leaves_ = 1;
  std::vector<Eigen::AlignedBox3d> boxes_;  // the children of k are 2 k and 2 k + 1
};

}  // namespace snare::coupling
