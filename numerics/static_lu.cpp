#include "numerics/static_lu.hpp"

#include "base/index.hpp"

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

/// The unknowns in their order: first those with few neighbours; one without a value on the diagonal, a multiplier for one, after
/// the last of its neighbours that have one. What such a row asks for may only be moved by the multiplier of another one, as a rate by the
/// force that holds the place: the stabiliser of that place has no pivot before. Of two it is the later one.
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
  std::vector<std::vector<int>> asks(at(n)), moves(at(n));  // of a multiplier's row; multipliers, of any other row
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

/// Four numbers for every row of a block, zero at first.
template <int rows>
struct Fours {
  struct Lanes {
    Four numbers = {};
  };
  std::array<Lanes, rows> of_row;

  Four& operator[](std::size_t row) { return of_row[row].numbers; }
};

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

/// Whether the processor takes four numbers at once.
bool has_fours() {
  static const bool avx2 = __builtin_cpu_supports("avx2") != 0;
  return avx2;
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
    for (; j < run.length; ++j) {
      double left = to[j];
      for (std::size_t r = 0; r < rows; ++r) left -= factors[r] * by[r][run.offset + j];
      to[j] = left;
    }
  }
}

[[gnu::always_inline]] inline bool StaticLu::eliminate() {
  for (int i = 0; i < order_; ++i) {
    for (int k = first_elimination_[at(i)]; k < first_elimination_[at(i) + 1]; ++k) {
      const Elimination& e = eliminations_[at(k)];
      by_rows(
          e.rows, [&](auto rows)
                      __attribute__((always_inline)) { eliminate_by<rows>(e, eliminations_[at(k) + 1].first_run); });
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

// A value of the vector is taken once for all rows of a block; four products at a time, added up in one order whatever the
// processor takes at once.
template <int rows>
[[gnu::always_inline]] inline std::array<double, rows> StaticLu::add_up(const std::array<int, rows>& begin,
                                                                        const Block& block) const {
  Fours<rows> four;
  std::array<double, rows> sums{};
  for (int k = block.first; k < block.last; ++k) {
    const Stretch& s = stretches_[at(k)];
    const double* const x = work_.data() + s.column;
    const double* const a = values_.data() + s.offset;
    int e = 0;
    for (; e + 4 <= s.length; e += 4) {
      const Four of_vector = *reinterpret_cast<const Four*>(x + e);
      for (std::size_t r = 0; r < rows; ++r) four[r] += *reinterpret_cast<const Four*>(a + begin[r] + e) * of_vector;
    }
    for (; e < s.length; ++e) {
      for (std::size_t r = 0; r < rows; ++r) sums[r] += a[begin[r] + e] * x[e];
    }
  }
  for (std::size_t r = 0; r < rows; ++r) sums[r] += (four[r][0] + four[r][2]) + (four[r][1] + four[r][3]);
  return sums;
}

template <int rows>
[[gnu::always_inline]] inline void StaticLu::forward(const Block& block) {
  std::array<int, rows> begin;
  for (int r = 0; r < rows; ++r) begin[at(r)] = start_[at(block.row + r)];
  std::array<double, rows> x = add_up<rows>(begin, block);
  for (int r = 0; r < rows; ++r) {
    const double* const row = values_.data() + diagonal_[at(block.row + r)] - r;
    double value = work_[block.row + r] - x[at(r)];
    for (int q = 0; q < r; ++q) value -= row[q] * x[at(q)];
    x[at(r)] = value;
  }
  for (int r = 0; r < rows; ++r) work_[block.row + r] = x[at(r)];
}

template <int rows>
[[gnu::always_inline]] inline void StaticLu::backward(const Block& block) {
  std::array<int, rows> begin;
  for (int r = 0; r < rows; ++r) begin[at(r)] = diagonal_[at(block.row + r)] + rows - r;
  std::array<double, rows> x = add_up<rows>(begin, block);
  for (int r = rows - 1; r >= 0; --r) {
    const double* const row = values_.data() + diagonal_[at(block.row + r)] - r;
    double value = work_[block.row + r] - x[at(r)];
    for (int q = rows - 1; q > r; --q) value -= row[q] * x[at(q)];
    x[at(r)] = value * inverse_[at(block.row + r)];
  }
  for (int r = 0; r < rows; ++r) work_[block.row + r] = x[at(r)];
}

[[gnu::always_inline]] inline void StaticLu::substitute() {
  for (const int i : alone_) work_[i] *= inverse_[at(i)];
  for (const Block& b : before_)
    by_rows(
        b.rows, [&](auto rows) __attribute__((always_inline)) { forward<rows>(b); });
  for (const Block& b : behind_)
    by_rows(
        b.rows, [&](auto rows) __attribute__((always_inline)) { backward<rows>(b); });
}

[[gnu::target("avx2")]] void StaticLu::substitute_in_fours() {
  substitute();
}

void StaticLu::substitute_in_pairs() {
  substitute();
}

void StaticLu::list_blocks() {
  const auto part = [&](int begin, int end) { return std::span(column_).subspan(at(begin), at(end - begin)); };
  const auto before = [&](int i) { return part(start_[at(i)], diagonal_[at(i)]); };
  const auto behind = [&](int i) { return part(diagonal_[at(i)] + 1, start_[at(i) + 1]); };
  // A row has what the one before has, and the diagonal of that besides.
  const auto same_before = [&](int i) {
    const auto own = before(i);
    return !own.empty() && own.back() == i - 1 && std::ranges::equal(own.first(own.size() - 1), before(i - 1));
  };
  const auto same_behind = [&](int i) {
    const auto others = behind(i - 1);
    return !others.empty() && others.front() == i && std::ranges::equal(others.subspan(1), behind(i));
  };
  const auto list = [&](std::span<const int> columns) {
    for (std::size_t e = 0; e < columns.size(); ++e) {
      if (e > 0 && columns[e] == columns[e - 1] + 1)
        ++stretches_.back().length;
      else
        stretches_.push_back({static_cast<int>(e), columns[e], 1});
    }
  };
  const auto join = [&](std::vector<Block>& blocks, const auto& same, const auto& columns) {
    for (int i = 0; i < order_;) {
      int end = i + 1;
      while (end < std::min(order_, i + most_rows) && same(end)) ++end;
      if (!before(i).empty() || !behind(i).empty()) {
        const auto first = static_cast<int>(stretches_.size());
        list(columns(i, end));
        blocks.push_back({i, end - i, first, static_cast<int>(stretches_.size())});
      }
      i = end;
    }
  };
  join(before_, same_before, [&](int i, int) { return before(i); });
  join(behind_, same_behind, [&](int, int end) { return behind(end - 1); });
  std::ranges::reverse(behind_);
  for (int i = 0; i < order_; ++i) {
    if (before(i).empty() && behind(i).empty()) alone_.push_back(i);
  }
}

StaticLu::StaticLu(const SparseMatrix& matrix)
    : order_(matrix.order), unknown_(elimination_order(matrix)), work_(order_) {
  std::vector<int> place(at(order_));
  for (int k = 0; k < order_; ++k) place[at(unknown_[at(k)])] = k;
  // After row k is used, every later row that has k has what k has: columns beyond k of the pattern of A + A^T and of the rows
  // whose first later column is k.
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
  values_.assign(column_.size(), 0.0);
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
  return has_fours() ? eliminate_in_fours() : eliminate_in_pairs();
}

void StaticLu::solve(Eigen::Ref<Eigen::VectorXd> b) {
  for (int i = 0; i < order_; ++i) work_[i] = b[unknown_[at(i)]];
  if (has_fours())
    substitute_in_fours();
  else
    substitute_in_pairs();
  for (int i = 0; i < order_; ++i) b[unknown_[at(i)]] = work_[i];
}

}  // namespace snare::numerics
