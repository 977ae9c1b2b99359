#pragma once

#include "base/index.hpp"
#include "numerics/lanes.hpp"

#include <algorithm>
#include <vector>

namespace snare::wire {

/// Which rows a rod in motion has at a point: of its vertices, of its edges, and of which number stands for
/// one. Vectors have three rows.
struct RodRow {
  enum : int {
    place = 0,
    velocity = place + 3,
    theta = velocity + 3,  ///< and its rate, of the edges
    theta_rate,
    curvature,  ///< of higher order, two
    old_tangent = curvature + 2,
    old_director = old_tangent + 3,  ///< at the last accepted state
    old_twist = old_director + 3,
    tangent,
    director = tangent + 3,
    twist = director + 3,  ///< that of the reference frames at a vertex
    first,
    second = first + 3,  ///< the material directors
    inverse_length = second + 3,
    tension,  ///< of an edge, with its damping, and the force along it
    force,
    torque = force + 3,
    by_curvature,
    rest_length = by_curvature + 2,
    is_edge,   ///< 1 or 0
    is_inner,  ///< whether a vertex is between the ends, 1 or 0
    count
  };
};

/// Rows of numbers, one for each vertex or edge of a rod, with some before and behind that stand for none, so
/// that four can be taken at once everywhere.
class RodRows {
 public:
  RodRows(int count, int vertices)
      : length_(before + (vertices + lanes - 1) / lanes * lanes + lanes),
        data_(base::at(count * length_), 0.0) {}

  /// How many vertices or edges have numbers, those that are none included.
  [[nodiscard]] int length() const { return length_ - before; }
  /// Of the first vertex or edge, in their units.
  [[nodiscard]] double* row(int r) { return data_.data() + r * length_ + before; }
  [[nodiscard]] const double* row(int r) const { return data_.data() + r * length_ + before; }

  /// Of four vertices or edges, i being the first: a number, or the three of three rows.
  [[nodiscard, gnu::always_inline]] numerics::Lanes at(int r, int i) const {
    return numerics::Lanes::at(row(r) + i);
  }
  [[nodiscard, gnu::always_inline]] numerics::Lanes3 at3(int r, int i) const {
    return numerics::Lanes3::at(row(r) + i, length_);
  }
  [[gnu::always_inline]] void set(int r, int i, const numerics::Lanes& value) { value.store(row(r) + i); }
  [[gnu::always_inline]] void set(int r, int i, const numerics::Lanes3& value) {
    value.store(row(r) + i, length_);
  }
  [[gnu::always_inline]] void add(int r, int i, const numerics::Lanes& value) { value.add_to(row(r) + i); }
  [[gnu::always_inline]] void add(int r, int i, const numerics::Lanes3& value) {
    value.add_to(row(r) + i, length_);
  }
  /// Zeros in all of them, or in some rows.
  void clear() { std::ranges::fill(data_, 0.0); }
  void clear(int first, int rows) { std::fill_n(data_.begin() + first * length_, rows * length_, 0.0); }

 private:
  static constexpr int lanes = numerics::Lanes::count;
  static constexpr int before = lanes;
  int length_;
  std::vector<double> data_;
};

}  // namespace snare::wire
