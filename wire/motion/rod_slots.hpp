#pragma once

#include "numerics/sparse_matrix.hpp"
#include "wire/motion/bending_cell.hpp"
#include "wire/motion/rod_model.hpp"

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
  [[nodiscard]] bool is_attached() const { return pattern_ != nullptr; }

  /// Adds to a balance by a place; nothing where the balance is not there (the row is held).
  void add_place(int row, int column, double value, std::vector<double>& values) const {
    add_to(values, place_[slot_of(row, column)], value);
  }
  /// Adds what vertex i's cell does to the balances: by the places, and by their rates, which are unknowns v
  /// of coordinates and c times the unknown of angles. None by a mount's angle.
  void add_cell(int i, const CellMatrix& by_place, const CellMatrix& by_rate, double c,
                std::vector<double>& values) const;
  /// Two products of vectors: balances by the places, sum_j force_j place_j^T + m, and by the rates, sum_j
  /// force_j rate_j^T.
  struct CellProducts {
    std::array<CellVector, 2> force, place, rate;
    CellMatrix m;
  };
  /// The same of a cell whose matrices these are.
  void add_cell(int i, const CellProducts& products, double c, std::vector<double>& values) const;
  /// Where that is, and where the same by a velocity is; -1: nowhere.
  [[nodiscard]] int place_slot(int row, int column) const { return place_[slot_of(row, column)]; }
  [[nodiscard]] int rate_slot(int row, int column) const { return rate_[slot_of(row, column)]; }
  /// Any entry, by row and column of the DAE.
  [[nodiscard]] int slot(int row, int column) const { return pattern_->slot(row, column); }
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
};

}  // namespace snare::wire
