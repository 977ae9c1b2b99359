#include "numerics/sparse_matrix.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

namespace snare::numerics {

using base::at;

int SparseMatrix::slot(int i, int j) const {
  const auto first = row.begin() + column_start[at(j)];
  const auto last = row.begin() + column_start[at(j) + 1];
  const auto found = std::lower_bound(first, last, i);
  return found != last && *found == i ? static_cast<int>(found - row.begin()) : -1;
}

SparseMatrix make_pattern(int order, const std::vector<std::pair<int, int>>& entries) {
  const auto columns = static_cast<std::size_t>(order);
  // Rows by columns, with the repeated ones; then every column in order and without them.
  std::vector<std::size_t> next(columns + 1, 0);
  for (const auto& [i, j] : entries) {
    assert(i >= 0 && i < order && j >= 0 && j < order);
    ++next[at(j) + 1];
  }
  for (std::size_t j = 0; j < columns; ++j) next[j + 1] += next[j];
  std::vector<int> rows(entries.size());
  for (const auto& [i, j] : entries) rows[next[at(j)]++] = i;
  SparseMatrix result;
  result.order = order;
  result.column_start.assign(columns + 1, 0);
  auto first = rows.begin();
  for (std::size_t j = 0; j < columns; ++j) {
    const auto last = rows.begin() + static_cast<std::ptrdiff_t>(next[j]);
    std::sort(first, last);
    std::unique_copy(first, last, std::back_inserter(result.row));
    result.column_start[j + 1] = static_cast<int>(result.row.size());
    first = last;
  }
  result.value.assign(result.row.size(), 0.0);
  return result;
}

namespace {

/// Calls f(row, column, value) for every entry, column by column.
template <typename Matrix, typename Function>
void for_each_entry(Matrix& matrix, const Function& f) {
  for (int j = 0; j < matrix.order; ++j) {
    for (int s = matrix.column_start[at(j)]; s < matrix.column_start[at(j) + 1]; ++s)
      f(matrix.row[at(s)], j, matrix.value[at(s)]);
  }
}

template <typename Vector>
Vector product_with(const SparseMatrix& matrix, const Vector& x) {
  Vector y = Vector::Zero(matrix.order);
  for_each_entry(matrix, [&](int i, int j, double value) { y[i] += value * x[j]; });
  return y;
}

}  // namespace

Eigen::MatrixXd dense(const SparseMatrix& matrix) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(matrix.order, matrix.order);
  for_each_entry(matrix, [&](int i, int j, double value) { full(i, j) = value; });
  return full;
}

Eigen::VectorXd product(const SparseMatrix& matrix, const Eigen::VectorXd& x) {
  return product_with(matrix, x);
}
Eigen::VectorXcd product(const SparseMatrix& matrix, const Eigen::VectorXcd& x) {
  return product_with(matrix, x);
}

void scale(SparseMatrix& matrix, const Eigen::VectorXd& rows, const Eigen::VectorXd& columns) {
  for_each_entry(matrix, [&](int i, int j, double& value) { value *= rows[i] * columns[j]; });
}

Eigen::VectorXd largest_of_rows(const SparseMatrix& matrix) {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(matrix.order);
  for_each_entry(matrix,
                 [&](int i, int, double value) { largest[i] = std::max(largest[i], std::abs(value)); });
  return largest;
}

SparseMatrix from_triplets(int order, const std::vector<Triplet>& triplets) {
  std::vector<std::pair<int, int>> pattern;
  pattern.reserve(triplets.size());
  for (const Triplet& t : triplets) pattern.emplace_back(t.row, t.column);
  SparseMatrix result = make_pattern(order, pattern);
  for (const Triplet& t : triplets)
    result.value[static_cast<std::size_t>(result.slot(t.row, t.column))] += t.value;
  return result;
}

std::vector<Triplet> triplets_of(const SymmetricBandMatrix& matrix, Triangle triangle) {
  std::vector<Triplet> triplets;
  const int n = matrix.order();
  for (int j = 0; j < n; ++j) {
    for (int i = j; i <= std::min(n - 1, j + matrix.half_bandwidth()); ++i) {
      const double value = matrix.lower(i, j);
      triplets.push_back({i, j, value});
      if (i != j && triangle == Triangle::both) triplets.push_back({j, i, value});
    }
  }
  return triplets;
}

}  // namespace snare::numerics
