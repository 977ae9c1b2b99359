#include "benchmarks/peers/bordered_pattern.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace snare::benchmarks {

namespace {

// Adds a value at a slot; a value outside the pattern must be zero.
bool put(SparseMatrix& matrix, int slot, double value) {
  if (slot < 0) return value == 0.0;
  matrix.value[static_cast<std::size_t>(slot)] += value;
  return true;
}

}  // namespace

BorderedPattern::BorderedPattern(const BorderedSystem& system, Zeros zeros)
    : n_(system.matrix.order()),
      m_(static_cast<int>(system.corner.rows())),
      b_(system.matrix.half_bandwidth()) {
  std::vector<std::pair<int, int>> entries;
  const auto want = [&entries, zeros](int i, int j, double value) {
    if (zeros == Zeros::kept || value != 0.0) entries.emplace_back(i, j);
  };
  for (int j = 0; j < n_; ++j) {
    for (int i = j; i <= std::min(n_ - 1, j + b_); ++i) {
      want(i, j, system.matrix.lower(i, j));
      if (i != j) want(j, i, system.matrix.lower(i, j));
    }
  }
  for (const BorderedSystem::Anchor& a : system.anchors) entries.emplace_back(a.band, n_ + a.border);
  for (const auto& [border, values] : system.columns) {
    for (int i = 0; i < n_; ++i) want(i, n_ + border, (*values)[i]);
  }
  for (const BorderedSystem::Entry& e : system.rows) entries.emplace_back(n_ + e.row, e.column);
  for (int i = 0; i < m_; ++i) {
    for (int j = 0; j < m_; ++j) want(n_ + i, n_ + j, system.corner(i, j));
  }
  pattern_ = numerics::make_pattern(n_ + m_, entries);

  for (int j = 0; j < n_; ++j) {
    for (int k = 0; k <= b_; ++k) {
      const bool inside = j + k < n_;
      lower_.push_back(inside ? pattern_.slot(j + k, j) : -1);
      upper_.push_back(inside && k > 0 ? pattern_.slot(j, j + k) : -1);
    }
  }
  for (const BorderedSystem::Anchor& a : system.anchors) {
    anchors_.push_back({a.band, a.border, pattern_.slot(a.band, n_ + a.border)});
  }
  for (const auto& column : system.columns) {
    borders_.push_back(column.first);
    for (int i = 0; i < n_; ++i) columns_.push_back({i, column.first, pattern_.slot(i, n_ + column.first)});
  }
  for (const BorderedSystem::Entry& e : system.rows) {
    rows_.push_back({e.row, e.column, pattern_.slot(n_ + e.row, e.column)});
  }
  for (int i = 0; i < m_; ++i) {
    for (int j = 0; j < m_; ++j) corner_.push_back(pattern_.slot(n_ + i, n_ + j));
  }
}

bool BorderedPattern::same_structure(const BorderedSystem& s) const {
  if (s.matrix.order() != n_ || s.matrix.half_bandwidth() != b_ || s.corner.rows() != m_) return false;
  const auto same_entry = [](const BorderedSystem::Entry& e, const Slot& slot) {
    return e.row == slot.row && e.column == slot.column;
  };
  const auto same_anchor = [](const BorderedSystem::Anchor& a, const Slot& slot) {
    return a.band == slot.row && a.border == slot.column;
  };
  const auto same_column = [](const auto& column, int border) { return column.first == border; };
  return std::equal(s.rows.begin(), s.rows.end(), rows_.begin(), rows_.end(), same_entry) &&
         std::equal(s.anchors.begin(), s.anchors.end(), anchors_.begin(), anchors_.end(), same_anchor) &&
         std::equal(s.columns.begin(), s.columns.end(), borders_.begin(), borders_.end(), same_column);
}

bool BorderedPattern::refill(const BorderedSystem& system, SparseMatrix& matrix) const {
  assert(matrix.value.size() == pattern_.value.size());
  if (!same_structure(system)) return false;
  std::fill(matrix.value.begin(), matrix.value.end(), 0.0);
  bool fits = true;
  std::size_t at = 0;
  for (int j = 0; j < n_; ++j) {
    const double* column = system.matrix.column(j);
    // What is stored beyond the last row belongs to no entry.
    const int last = std::min(b_, n_ - 1 - j);
    for (int k = 0; k <= last; ++k) {
      fits = put(matrix, lower_[at + static_cast<std::size_t>(k)], column[k]) && fits;
      if (k > 0) fits = put(matrix, upper_[at + static_cast<std::size_t>(k)], column[k]) && fits;
    }
    at += static_cast<std::size_t>(b_) + 1;
  }
  for (const Slot& s : anchors_) matrix.value[static_cast<std::size_t>(s.slot)] -= 1.0;
  at = 0;
  for (const auto& column : system.columns) {
    for (int i = 0; i < n_; ++i) fits = put(matrix, columns_[at++].slot, (*column.second)[i]) && fits;
  }
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    matrix.value[static_cast<std::size_t>(rows_[k].slot)] += system.rows[k].value;
  }
  at = 0;
  for (int i = 0; i < m_; ++i) {
    for (int j = 0; j < m_; ++j) fits = put(matrix, corner_[at++], system.corner(i, j)) && fits;
  }
  return fits;
}

SparseMatrix to_sparse(const numerics::SymmetricBandMatrix& matrix, numerics::Triangle triangle) {
  return numerics::from_triplets(matrix.order(), numerics::triplets_of(matrix, triangle));
}

}  // namespace snare::benchmarks
