#pragma once

#include "numerics/cubic_spline.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace snare::coupling {

/// What a law does outside its range.
enum class Outside {
  refuse,      ///< throws std::domain_error with the value and the range
  extrapolate  ///< answers, and says so
};

/// A law's answer.
struct LawValue {
  double force = 0.0;      ///< [N]
  double stiffness = 0.0;  ///< dF/dd [N/m]
  bool extrapolated = false;
};

/// The exact table: a tricubic C1 spline of the force over travel, position and slack.  theory.md (R.2)-(R.4)
///
/// Held in dimensionless groups, F L^2/EI over (d/L, s/L, slack/L): it serves every wire of the same EA
/// L^2/EI, R/L and friction. Nodes carry the value and its derivatives d, s, ds, e, de, se, dse, in this
/// order; the slope along the travel is held so that the force along every line of nodes rises where its
/// nodes do. Negative travel is no contact: 0.
class ForceTable {
 public:
  static constexpr std::size_t numbers_a_node = 8;
  using Axes = std::array<std::vector<double>, 3>;  ///< travel, position, slack over the span; ascending

  /// Values and slopes along the travel at the nodes, travel fastest, slack slowest. mirrored: position
  /// counts from the nearer mount, and has no slope at mid-span.
  ForceTable(Axes axes, const std::vector<double>& values, const std::vector<double>& slopes, double span,
             double bending_stiffness, bool mirrored);
  /// The table that has these nodes (see `nodes`) and this `force_scale`, as a file holds it: the same to the
  /// last bit. As many nodes as the axes have knots, every axis ascending, travel of two knots at least.
  [[nodiscard]] static ForceTable from_nodes(Axes axes, std::vector<double> nodes, double span,
                                             double force_scale, bool mirrored) {
    ForceTable table(std::move(axes), span, force_scale, mirrored);
    table.nodes_ = std::move(nodes);
    return table;
  }

  /// travel, position, slack [m]. Throws std::domain_error outside with Outside::refuse.
  [[nodiscard]] LawValue at(double travel, double position, double slack, Outside outside) const;
  /// Force inside the range, nothing checked [N].
  [[nodiscard]] double force(double travel, double position, double slack) const noexcept;

  /// The force along the travel at one place, with its energy (integral).
  [[nodiscard]] numerics::HermiteCurve curve(double position, double slack) const;

  /// Whether dF/dd >= 0 in the whole range: proven where all Bernstein coefficients of dF/dd are.
  [[nodiscard]] bool proven_monotone() const;
  /// Least dF/dd on a lattice of `refinement` intervals a cell [N/m].
  [[nodiscard]] double least_stiffness(int refinement) const;

  /// Knots of travel, position and slack over the span [-], ascending.
  [[nodiscard]] const Axes& axes() const noexcept { return axes_; }
  /// Numbers of the nodes in groups of numbers_a_node, travel fastest, slack slowest: F L^2/EI and its
  /// derivatives [-].
  [[nodiscard]] const std::vector<double>& nodes() const noexcept { return nodes_; }
  /// Distance of the mounts L [m], > 0.
  [[nodiscard]] double span() const noexcept { return span_; }
  [[nodiscard]] double force_scale() const noexcept { return force_scale_; }  ///< EI/L^2 [N]
  [[nodiscard]] bool mirrored() const noexcept { return mirrored_; }

 private:
  /// Finds cells of an axis in constant time, by a guide over even steps.
  struct Lookup {
    double low = 0.0;
    double steps_per_unit = 0.0;
    std::vector<unsigned> guide;         // cell in which each step begins
    std::vector<double> inverse_widths;  // of the cells
    [[nodiscard]] std::size_t cell(const std::vector<double>& knots, double x) const noexcept;
  };
  struct Cell {
    std::array<std::size_t, 3> index{};
    std::array<std::array<double, 4>, 3> basis{};  // value and slope at the lower, then at the upper knot
  };
  /// A table without nodes.
  ForceTable(Axes axes, double span, double force_scale, bool mirrored);
  /// Where the numbers of the node (travel k, position i, slack j) begin.
  [[nodiscard]] std::size_t node(std::size_t k, std::size_t i, std::size_t j) const noexcept {
    return numbers_a_node * (k + axes_[0].size() * (i + axes_[1].size() * j));
  }
  [[nodiscard]] std::array<double, 3> reduced(double travel, double position, double slack) const noexcept;
  [[nodiscard]] Cell locate(const std::array<double, 3>& x) const noexcept;
  [[nodiscard]] double sum(const Cell& cell) const noexcept;
  [[nodiscard]] double derivative(const std::array<double, 3>& x, std::size_t axis) const noexcept;
  /// Whether dF/dd >= 0 in the cell above the knots (k, i, j), by its Bernstein coefficients.
  [[nodiscard]] bool rises_in_cell(std::size_t k, std::size_t i, std::size_t j) const;

  Axes axes_;
  std::array<Lookup, 3> lookup_;
  std::vector<double> nodes_;  // numbers_a_node each
  double span_;
  double force_scale_;
  bool mirrored_;
};

}  // namespace snare::coupling
