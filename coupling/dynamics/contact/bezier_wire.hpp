#pragma once

#include "numerics/dae.hpp"
#include "wire/motion/rod_part.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::coupling {

/// The C1 curve of a wire (M.6), element by element as cubics in Bernstein form: each stays in the convex
/// hull of its four control points, and so does every derivative by time in the hull of theirs.
///                                                                                            theory.md (G.6)
class BezierWire {
 public:
  using Control = Eigen::Matrix<double, 3, 4>;

  /// The rod stays the caller's; where its unknowns are is asked when they are wanted.
  explicit BezierWire(const wire::RodPart& rod);

  /// How many elements the curve has.
  [[nodiscard]] int elements() const { return static_cast<int>(pieces_.size()); }
  /// Control points of an element, from positions [m] or any derivative of them by time, in the layout of the
  /// unknowns.
  [[nodiscard]] Control control(int element, const numerics::VectorView& y) const;
  [[nodiscard]] double begin(int element) const { return piece(element).begin; }    ///< [m]
  [[nodiscard]] double length(int element) const { return piece(element).length; }  ///< [m]
  [[nodiscard]] double longest() const { return longest_; }                         ///< element [m]
  [[nodiscard]] double shortest() const { return shortest_; }                       ///< element [m]
  /// Largest sum of the moduli of a control point's weights: bounds control points by vertices. [-], >= 1.
  [[nodiscard]] double largest_weight_sum() const { return largest_weight_sum_; }
  /// The element that holds a material coordinate [m]; the last one beyond the end.
  [[nodiscard]] int element_at(double coordinate) const;
  /// First of the four vertices on which an element depends.
  [[nodiscard]] int first_vertex(int element) const { return piece(element).first; }
  /// Weights of these vertices in X at u, 0 to 1 along the element, in X' [1/m] and in X'' [1/m^2] (M.6).
  [[nodiscard]] Eigen::Vector4d value(int element, double u) const;
  [[nodiscard]] Eigen::Vector4d slope(int element, double u) const;
  [[nodiscard]] Eigen::Vector4d bend(int element, double u) const;

 private:
  struct Piece {
    double begin = 0.0, length = 0.0;  // [m]
    int first = 0;                     // of four vertices
    Eigen::Matrix4d weights;           // of vertices (rows) in control points (columns)
  };
  [[nodiscard]] const Piece& piece(int element) const { return pieces_[static_cast<std::size_t>(element)]; }

  std::vector<Piece> pieces_;
  const wire::RodPart& rod_;
  double longest_ = 0.0, shortest_ = 0.0;
  double largest_weight_sum_ = 1.0;
};

/// Bernstein's cubics at u, their first and their second derivatives by u. u in [0, 1]; results (4) [-].
[[nodiscard]] Eigen::Vector4d bernstein(double u);
[[nodiscard]] Eigen::Vector4d bernstein_slope(double u);
[[nodiscard]] Eigen::Vector4d bernstein_bend(double u);
/// The largest |d2X/du2| of a cubic [m], which is at one of its ends.
[[nodiscard]] double largest_bend(const BezierWire::Control& control);

}  // namespace snare::coupling
