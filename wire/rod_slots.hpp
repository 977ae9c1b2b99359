#pragma once

#include "numerics/sparse_matrix.hpp"
#include "wire/bending_cell.hpp"
#include "wire/rod_model.hpp"

#include <array>
#include <utility>
#include <vector>

namespace snare::wire {

/// Entries of a rod's Jacobian, as (row, column).
void append_sparsity(const RodModel& model, std::vector<std::pair<int, int>>& entries);

/// Where the entries of a rod's Jacobian are among the values of a sparse matrix. Rows and columns are band
/// indices (see RodModel): the row is that of the balance, the column that of a place (x, theta) or of a rate
/// (v). Values are of the units of their rows over those of their columns, in SI.
class RodSlots {
 public:
  /// `model` and `pattern` stay the caller's.
  void attach(const RodModel& model, const numerics::SparseMatrix& pattern);

  /// Adds to a balance by a place; nothing where the balance is not there (the row is held).
  void add_place(int row, int column, double value, std::vector<double>& values) const {
    add_to(values, place_[slot_of(row, column)], value);
  }
  /// The same by the velocity of the column's coordinate.
  void add_rate(int row, int column, double value, std::vector<double>& values) const {
    add_to(values, rate_[slot_of(row, column)], value);
  }
  /// Adds what vertex i's cell does to the balances: by the places, and by their rates, which are unknowns v
  /// of coordinates and c times the unknown of angles. None by a mount's angle.
  void add_cell(int i, const CellMatrix& by_place, const CellMatrix& by_rate, double c,
                std::vector<double>& values) const;
  /// Two products of vectors: balances by the places, sum_j force_j place_j^T + m, and by the rates, sum_j force_j rate_j^T.
  struct CellProducts {
    std::array<CellVector, 2> force, place, rate;
    CellMatrix m;
  };
  /// The same of a cell whose matrices these are.
  void add_cell(int i, const CellProducts& products, double c, std::vector<double>& values) const;
  /// Adds second derivatives by the places of vertex i's cell.
  void add_cell(int i, const CellMatrix& by_place, std::vector<double>& values) const;
  /// Adds a 3 x 3 block by places from a band on.
  void add_places(int row, int column, const Eigen::Matrix3d& block, std::vector<double>& values) const {
    for (int r = 0; r < 3; ++r) {
      for (int s = 0; s < 3; ++s) add_place(row + r, column + s, block(r, s), values);
    }
  }

  /// Of the balances of a vertex's cell by its curvatures.
  using CurvatureColumns = Eigen::Matrix<double, CellRows::count, 2>;
  /// Adds what couples vertex i's curvatures with its cell, on both sides of the diagonal, and with themselves. Rows of
  /// a vertex that does not bend have nothing by the cell.
  void add_curvature(int i, const CurvatureColumns& by_cell, const Eigen::Matrix2d& own,
                     std::vector<double>& values) const;
  /// Adds what couples the curvatures of vertices i (rows) and i + 1, on both sides.
  void add_curvature_pair(int i, const Eigen::Matrix2d& block, std::vector<double>& values) const;
  [[nodiscard]] bool has_balance(int band) const { return place_[slot_of(band, band)] >= 0; }

  /// Slots of x' - v = 0 and of m v' in the balance (x = X, v = 0 where held).
  struct Diagonal {
    int place = -1;              ///< (x, x) or (theta, theta)
    int place_by_velocity = -1;  ///< (x, v)
    int velocity = -1;           ///< (v, v)
  };
  [[nodiscard]] const Diagonal& diagonal(int band) const { return diagonal_[base::at(band)]; }

  /// Any entry, by row and column of the DAE.
  void add(int row, int column, double value, std::vector<double>& values) const {
    add_to(values, pattern_->slot(row, column), value);
  }
  static void add_to(std::vector<double>& values, int slot, double value) {
    if (slot >= 0) values[base::at(slot)] += value;
  }

 private:
  [[nodiscard]] static std::size_t slot_of(int row, int column) {
    return base::at(row * width + (column - row + reach));
  }
  static constexpr int reach = SpatialRod::half_bandwidth;
  static constexpr int width = 2 * reach + 1;

  const numerics::SparseMatrix* pattern_ = nullptr;
  int bands_ = 0;
  std::vector<int> place_;  // the band row by row, -1 where there is no entry
  std::vector<int> rate_;
  std::vector<Diagonal> diagonal_;
  /// Of a vertex's cell, column by column.
  struct CellSlots {
    std::array<int, CellRows::count * CellRows::count> place{}, rate{};
  };
  std::vector<CellSlots> cells_;
  struct CurvatureSlots {
    std::array<std::array<int, 2>, CellRows::count> column{}, row{};  // balances by k, rows of k by places
    std::array<std::array<int, 2>, 2> own{}, next{}, next_transposed{};
  };
  std::vector<CurvatureSlots> curvature_;  // of every vertex of a rod of higher order
};

}  // namespace snare::wire
