#include "numerics/static_lu.hpp"

#include "base/index.hpp"
#include "numerics/lanes.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>

namespace snare::numerics {

using base::at;

namespace {

/// The unknowns in their order: first those with few neighbours; one without a value on the diagonal, a
/// multiplier for one, after the last of its neighbours that have one. What such a row asks for may only be
/// moved by the multiplier of another one, as a rate by the force that holds the place: the stabiliser of
/// that place has no pivot before. Of two it is the later one.
std::vector<int> elimination_order(const SparseMatrix& matrix) {
  const int n = matrix.order;
  const Eigen::Map<const Eigen::SparseMatrix<double>> view(n, n, static_cast<Eigen::Index>(matrix.row.size()),
                                                           matrix.column_start.data(), matrix.row.data(),
                                                           matrix.value.data());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(Eigen::SparseMatrix<double>(view), order);
  std::vector<int> place(at(n));
  for (int k = 0; k < n; ++k) place[at(order.indices()[k])] = k;
  std::vector<bool> zero(at(n));
  for (int j = 0; j < n; ++j) {
    const int slot = matrix.slot(j, j);
    zero[at(j)] = slot < 0 || matrix.value[at(slot)] == 0.0;
  }
  std::vector<int> after(at(n));  // twice the place, and one more than twice that of the last neighbour
  std::vector<std::vector<int>> asks(at(n)),
      moves(at(n));  // of a multiplier's row; multipliers, of any other row
  for (int u = 0; u < n; ++u) after[at(u)] = 2 * place[at(u)];
  for (int j = 0; j < n; ++j) {
    for (int s = matrix.column_start[at(j)]; s < matrix.column_start[at(j) + 1]; ++s) {
      const int i = matrix.row[at(s)];
      if (zero[at(i)] == zero[at(j)]) continue;
      const int multiplier = zero[at(i)] ? i : j, other = zero[at(i)] ? j : i;
      after[at(multiplier)] = std::max(after[at(multiplier)], 2 * place[at(other)] + 1);
      if (multiplier == i)
        asks[at(i)].push_back(j);
      else
        moves[at(i)].push_back(j);
    }
  }
  for (int u = 0; u < n; ++u) {
    for (const int asked : asks[at(u)]) {
      for (const int by : moves[at(asked)])
        if (by < u) after[at(u)] = std::max(after[at(u)], after[at(by)]);
    }
  }
  std::vector<int> unknowns(at(n));
  std::iota(unknowns.begin(), unknowns.end(), 0);
  const auto key = [&](int u) { return std::pair(after[at(u)], zero[at(u)] ? u : place[at(u)]); };
  std::sort(unknowns.begin(), unknowns.end(), [&](int a, int b) { return key(a) < key(b); });
  return unknowns;
}

/// Four numbers at once, where they are.
using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;

/// Which of four numbers count; by a bitwise "and" the others are zero.
using Mask [[gnu::vector_size(32)]] = long long;
constexpr std::array<Mask, 4> first_of_four{Mask{0, 0, 0, 0}, Mask{-1, 0, 0, 0}, Mask{-1, -1, 0, 0},
                                            Mask{-1, -1, -1, 0}};

/// The work on a block of one to four rows, whose number the compiler knows.
template <class Work>
[[gnu::always_inline]] inline void by_rows(int rows, const Work& work) {
  if (rows == 4)
    work(std::integral_constant<int, 4>());
  else if (rows == 3)
    work(std::integral_constant<int, 3>());
  else if (rows == 2)
    work(std::integral_constant<int, 2>());
  else
    work(std::integral_constant<int, 1>());
}

}  // namespace

// A value is taken and put back once for all rows of a block.
template <int rows>
[[gnu::always_inline]] inline void StaticLu::eliminate_by(const Elimination& e, int last_run) {
  double* const values = values_.data();
  std::array<double, rows> factors;
  std::array<const double*, rows> by;
  for (int r = 0; r < rows; ++r) {
    double value = values[e.entry + r];
    for (int q = 0; q < r; ++q) value -= factors[at(q)] * values[diagonal_[at(e.row + q)] + r - q];
    const double factor = value * inverse_[at(e.row + r)];
    values[e.entry + r] = factors[at(r)] = factor;
    by[at(r)] = values + start_[at(e.row + r + 1)] - e.common;
  }
  for (int k = e.first_run; k < last_run; ++k) {
    const Run& run = runs_[at(k)];
    double* const to = values + run.to;
    int j = 0;
    for (; j + 4 <= run.length; j += 4) {
      Four left = *reinterpret_cast<const Four*>(to + j);
      for (std::size_t r = 0; r < rows; ++r)
        left -= factors[r] * *reinterpret_cast<const Four*>(by[r] + run.offset + j);
      *reinterpret_cast<Four*>(to + j) = left;
    }
    if (j == run.length) continue;
    // The last one to three as four, of which the others stay what they are.
    const Mask& rest = first_of_four[at(run.length - j)];
    Four left = *reinterpret_cast<const Four*>(to + j);
    for (std::size_t r = 0; r < rows; ++r) {
      const Mask entries =
          reinterpret_cast<Mask>(*reinterpret_cast<const Four*>(by[r] + run.offset + j)) & rest;
      left -= factors[r] * reinterpret_cast<Four>(entries);
    }
    *reinterpret_cast<Four*>(to + j) = left;
  }
}

[[gnu::always_inline]] inline bool StaticLu::eliminate() {
  for (int i = 0; i < order_; ++i) {
    for (int k = first_elimination_[at(i)]; k < first_elimination_[at(i) + 1]; ++k) {
      const Elimination& e = eliminations_[at(k)];
      by_rows(
          e.rows, [&](auto rows) __attribute__((always_inline)) {
            eliminate_by<rows>(e, eliminations_[at(k) + 1].first_run);
          });
    }
    inverse_[at(i)] = 1.0 / values_[at(diagonal_[at(i)])];
    if (!std::isfinite(inverse_[at(i)]) || inverse_[at(i)] == 0.0) return false;
  }
  return true;
}

// No product is joined with its difference in one rounding, so that all processors give the same bits.
[[gnu::target("avx2")]] bool StaticLu::eliminate_in_fours() {
  return eliminate();
}

bool StaticLu::eliminate_in_pairs() {
  return eliminate();
}

// The four rows of a block are the four numbers at once: what a column takes from them needs one number of
// the vector. Rows that a block does not have are others' and stay: nothing is taken from them, and their
// part of the square is 1.
[[gnu::always_inline]] inline void StaticLu::solve_block(const Block& block) {
  const Four* const entries = reinterpret_cast<const Four*>(columns_.data()) + block.first;
  const Four* const square = reinterpret_cast<const Four*>(squares_.data()) + most_rows * block.square;
  const int* const column = listed_.data() + block.first;
  const int count = block.last - block.first;
  double* const x = work_.data();
  Four* const own = reinterpret_cast<Four*>(x + block.row);
  Four even = *own, odd = {};
  int k = 0;
  for (; k + 2 <= count; k += 2) {
    even -= x[column[k]] * entries[k];
    odd -= x[column[k + 1]] * entries[k + 1];
  }
  if (k < count) even -= x[column[k]] * entries[k];
  even += odd;
  *own = (even[0] * square[0] + even[1] * square[1]) + (even[2] * square[2] + even[3] * square[3]);
}

[[gnu::always_inline]] inline void StaticLu::substitute() {
  for (const int i : alone_) work_[at(i)] *= inverse_[at(i)];
  for (const Block& b : before_) solve_block(b);
  for (const Block& b : behind_) solve_block(b);
}

[[gnu::target("avx2")]] void StaticLu::substitute_in_fours() {
  substitute();
}

void StaticLu::substitute_in_pairs() {
  substitute();
}

// L of a square has ones on its diagonal, U the pivots.
void StaticLu::invert_square(const Block& block, bool upper) {
  double* const inverse = squares_.data() + most_rows * most_rows * block.square;
  const auto entry = [&](int r, int s) { return values_[at(diagonal_[at(block.row + r)] + s - r)]; };
  const auto of = [inverse](int r, int s) -> double& { return inverse[most_rows * s + r]; };
  std::fill_n(inverse, most_rows * most_rows, 0.0);
  for (int r = block.rows; r < most_rows; ++r) of(r, r) = 1.0;
  for (int s = 0; s < block.rows; ++s) {
    of(s, s) = upper ? inverse_[at(block.row + s)] : 1.0;
    for (int r = s + 1; !upper && r < block.rows; ++r) {
      for (int q = s; q < r; ++q) of(r, s) -= entry(r, q) * of(q, s);
    }
    for (int r = s - 1; upper && r >= 0; --r) {
      for (int q = r + 1; q <= s; ++q) of(r, s) -= entry(r, q) * of(q, s);
      of(r, s) *= inverse_[at(block.row + r)];
    }
  }
}

void StaticLu::gather() {
  for (std::size_t k = 0; k < entry_.size(); ++k) columns_[k] = values_[at(entry_[k])];
  for (const Block& b : before_) invert_square(b, false);
  for (const Block& b : behind_) invert_square(b, true);
}

void StaticLu::list_blocks() {
  const auto part = [&](int begin, int end) {
    return std::span(column_).subspan(at(begin), at(end - begin));
  };
  const auto before = [&](int i) { return part(start_[at(i)], diagonal_[at(i)]); };
  const auto behind = [&](int i) { return part(diagonal_[at(i)] + 1, start_[at(i) + 1]); };
  // A row has what the one before has, and the diagonal of that besides.
  const auto same_before = [&](int i) {
    const auto own = before(i);
    return !own.empty() && own.back() == i - 1 &&
           std::ranges::equal(own.first(own.size() - 1), before(i - 1));
  };
  const auto same_behind = [&](int i) {
    const auto others = behind(i - 1);
    return !others.empty() && others.front() == i && std::ranges::equal(others.subspan(1), behind(i));
  };
  const int none = static_cast<int>(column_.size());  // behind the entries: zero
  const auto list = [&](int row, int rows, std::span<const int> columns, const auto& first_entry) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      listed_.push_back(columns[c]);
      for (int r = 0; r < most_rows; ++r)
        entry_.push_back(r < rows ? first_entry(row + r, r) + static_cast<int>(c) : none);
    }
  };
  const auto join = [&](std::vector<Block>& blocks, const auto& same, const auto& columns,
                        const auto& first_entry) {
    for (int i = 0; i < order_;) {
      int end = i + 1;
      while (end < std::min(order_, i + most_rows) && same(end)) ++end;
      if (!before(i).empty() || !behind(i).empty()) {
        const auto first = static_cast<int>(listed_.size());
        list(i, end - i, columns(i, end), [&](int row, int r) { return first_entry(row, end - i, r); });
        const auto square = static_cast<int>(before_.size() + behind_.size());
        blocks.push_back({i, end - i, first, static_cast<int>(listed_.size()), square});
      }
      i = end;
    }
  };
  join(
      before_, same_before, [&](int i, int) { return before(i); },
      [&](int row, int, int) { return start_[at(row)]; });
  join(
      behind_, same_behind, [&](int, int end) { return behind(end - 1); },
      [&](int row, int rows, int r) { return diagonal_[at(row)] + rows - r; });
  std::ranges::reverse(behind_);
  for (int i = 0; i < order_; ++i) {
    if (before(i).empty() && behind(i).empty()) alone_.push_back(i);
  }
  columns_.assign(entry_.size(), 0.0);
  squares_.assign(most_rows * most_rows * (before_.size() + behind_.size()), 0.0);
}

StaticLu::StaticLu(const SparseMatrix& matrix)
    : order_(matrix.order), unknown_(elimination_order(matrix)), work_(at(order_ + most_rows), 0.0) {
  std::vector<int> place(at(order_));
  for (int k = 0; k < order_; ++k) place[at(unknown_[at(k)])] = k;
  // After row k is used, every later row that has k has what k has: columns beyond k of the pattern of A +
  // A^T and of the rows whose first later column is k.
  std::vector<std::vector<int>> after(at(order_)), waiting(at(order_));
  for (int j = 0; j < order_; ++j) {
    for (int s = matrix.column_start[at(j)]; s < matrix.column_start[at(j) + 1]; ++s) {
      const int a = place[at(j)], b = place[at(matrix.row[at(s)])];
      if (a != b) after[at(std::min(a, b))].push_back(std::max(a, b));
    }
  }
  std::vector<std::vector<int>> before(at(order_));
  std::vector<int> both;
  for (int k = 0; k < order_; ++k) {
    std::vector<int>& list = after[at(k)];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    for (const int child : waiting[at(k)]) {
      const std::vector<int>& of_child = after[at(child)];
      both.clear();
      std::set_union(list.begin(), list.end(), of_child.begin() + 1, of_child.end(),  // its first is k
                     std::back_inserter(both));
      std::swap(list, both);
    }
    if (!list.empty()) waiting[at(list.front())].push_back(k);
    for (const int i : list) before[at(i)].push_back(k);
  }
  for (int i = 0; i < order_; ++i) {
    start_.push_back(static_cast<int>(column_.size()));
    column_.insert(column_.end(), before[at(i)].begin(), before[at(i)].end());
    diagonal_.push_back(static_cast<int>(column_.size()));
    column_.push_back(i);
    column_.insert(column_.end(), after[at(i)].begin(), after[at(i)].end());
  }
  start_.push_back(static_cast<int>(column_.size()));
  list_blocks();
  values_.assign(column_.size() + most_rows, 0.0);  // the rest of the last four, too
  inverse_.assign(at(order_), 0.0);
  std::vector<std::vector<int>> slots(at(order_));  // of the matrix, by row
  std::vector<int> column_of(matrix.row.size());
  for (int j = 0; j < order_; ++j) {
    for (int s = matrix.column_start[at(j)]; s < matrix.column_start[at(j) + 1]; ++s) {
      slots[at(place[at(matrix.row[at(s)])])].push_back(s);
      column_of[at(s)] = place[at(j)];
    }
  }
  target_.assign(matrix.row.size(), 0);
  std::vector<int> end_of_block(at(order_));  // to which a row belongs by what is behind
  for (const Block& b : behind_) {
    for (int i = b.row; i < b.row + b.rows; ++i) end_of_block[at(i)] = b.row + b.rows;
  }
  std::vector<int> entry(at(order_));  // of every column that the row has
  for (int i = 0; i < order_; ++i) {
    for (int e = start_[at(i)]; e < start_[at(i) + 1]; ++e) entry[at(column_[at(e)])] = e;
    for (const int s : slots[at(i)]) target_[at(s)] = entry[at(column_of[at(s)])];
    first_elimination_.push_back(static_cast<int>(eliminations_.size()));
    for (int e = start_[at(i)]; e < diagonal_[at(i)];) {
      const int k = column_[at(e)];
      const int rows = std::min(end_of_block[at(k)], i) - k;
      const int common = start_[at(k + rows)] - diagonal_[at(k + rows) - 1] - 1;
      eliminations_.push_back({e, k, rows, common, static_cast<int>(runs_.size())});
      const std::size_t first_run = runs_.size();
      for (int c = 0; c < common; ++c) {
        const int to = entry[at(column_[at(start_[at(k + rows)] - common + c)])];
        if (runs_.size() > first_run && runs_.back().to + runs_.back().length == to)
          ++runs_.back().length;
        else
          runs_.push_back({c, to, 1});
      }
      e += rows;
    }
  }
  first_elimination_.push_back(static_cast<int>(eliminations_.size()));
  eliminations_.push_back({0, 0, 0, 0, static_cast<int>(runs_.size())});
}

bool StaticLu::factorize(const SparseMatrix& matrix) {
  std::fill(values_.begin(), values_.end(), 0.0);
  for (std::size_t s = 0; s < target_.size(); ++s) values_[at(target_[s])] = matrix.value[s];
  if (!(has_four_lanes() ? eliminate_in_fours() : eliminate_in_pairs())) return false;
  gather();
  return true;
}

void StaticLu::solve(Eigen::Ref<Eigen::VectorXd> b) {
  for (int i = 0; i < order_; ++i) work_[at(i)] = b[unknown_[at(i)]];
  if (has_four_lanes())
    substitute_in_fours();
  else
    substitute_in_pairs();
  for (int i = 0; i < order_; ++i) b[unknown_[at(i)]] = work_[at(i)];
}

}  // namespace snare::numerics
