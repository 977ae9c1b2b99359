#include "numerics/static_lu.hpp"

#include "base/index.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
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

/// Two and four numbers at once, where they are.
using Two [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;
using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;

}  // namespace

// Runs are short: what the compiler makes of the plain loop spends most of its time on the question how long they are.
[[gnu::always_inline]] inline bool StaticLu::eliminate(bool by_four) {
  double* const values = values_.data();
  for (int i = 0; i < order_; ++i) {
    for (int q = first_elimination_[at(i)]; q < first_elimination_[at(i) + 1]; ++q) {
      const Elimination& e = eliminations_[at(q)];
      const double factor = values[e.entry] * inverse_[at(e.row)];
      values[e.entry] = factor;
      const Two two{factor, factor};
      const Four four{factor, factor, factor, factor};
      const int last = eliminations_[at(q) + 1].first_run;
      for (int r = e.first_run; r < last; ++r) {
        const Run& run = runs_[at(r)];
        const double* from = values + run.from;
        double* to = values + run.to;
        const double* const end = from + run.length;
        for (; by_four && end - from >= 4; from += 4, to += 4)
          *reinterpret_cast<Four*>(to) -= four * *reinterpret_cast<const Four*>(from);
        for (; end - from >= 2; from += 2, to += 2)
          *reinterpret_cast<Two*>(to) -= two * *reinterpret_cast<const Two*>(from);
        if (from != end) *to -= factor * *from;
      }
    }
    inverse_[at(i)] = 1.0 / values[diagonal_[at(i)]];
    if (!std::isfinite(inverse_[at(i)]) || inverse_[at(i)] == 0.0) return false;
  }
  return true;
}

// No product is joined with its difference in one rounding, so that all processors give the same bits.
[[gnu::target("avx2")]] bool StaticLu::eliminate_by_four() {
  return eliminate(true);
}

bool StaticLu::eliminate_by_two() {
  return eliminate(false);
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
  std::vector<int> entry(at(order_));  // of every column that the row has
  for (int i = 0; i < order_; ++i) {
    for (int e = start_[at(i)]; e < start_[at(i) + 1]; ++e) entry[at(column_[at(e)])] = e;
    for (const int s : slots[at(i)]) target_[at(s)] = entry[at(column_of[at(s)])];
    first_elimination_.push_back(static_cast<int>(eliminations_.size()));
    for (int e = start_[at(i)]; e < diagonal_[at(i)]; ++e) {
      const int k = column_[at(e)];
      eliminations_.push_back({e, k, static_cast<int>(runs_.size())});
      Run run;
      for (int from = diagonal_[at(k)] + 1; from < start_[at(k) + 1]; ++from) {
        const int to = entry[at(column_[at(from)])];
        if (run.to + run.length == to && run.length > 0) {
          ++run.length;
        } else {
          if (run.length > 0) runs_.push_back(run);
          run = {from, to, 1};
        }
      }
      if (run.length > 0) runs_.push_back(run);
    }
  }
  first_elimination_.push_back(static_cast<int>(eliminations_.size()));
  eliminations_.push_back({0, 0, static_cast<int>(runs_.size())});
}

bool StaticLu::factorize(const SparseMatrix& matrix) {
  std::fill(values_.begin(), values_.end(), 0.0);
  for (std::size_t s = 0; s < target_.size(); ++s) values_[at(target_[s])] = matrix.value[s];
  static const bool by_four = __builtin_cpu_supports("avx2") != 0;
  return by_four ? eliminate_by_four() : eliminate_by_two();
}

void StaticLu::solve(Eigen::Ref<Eigen::VectorXd> b) {
  const double* const values = values_.data();
  const int* const column = column_.data();
  double* const x = work_.data();
  const auto products = [&](int begin, int end) {
    double even = 0.0, odd = 0.0;
    int e = begin;
    for (; e + 1 < end; e += 2) {
      even += values[e] * x[column[e]];
      odd += values[e + 1] * x[column[e + 1]];
    }
    if (e < end) even += values[e] * x[column[e]];
    return even + odd;
  };
  for (int i = 0; i < order_; ++i) x[i] = b[unknown_[at(i)]] - products(start_[at(i)], diagonal_[at(i)]);
  for (int i = order_ - 1; i >= 0; --i) {
    x[i] = (x[i] - products(diagonal_[at(i)] + 1, start_[at(i) + 1])) * inverse_[at(i)];
    b[unknown_[at(i)]] = x[i];
  }
}

}  // namespace snare::numerics
