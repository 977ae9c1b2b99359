#include "numerics/dae_solver.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::numerics {

using base::at;

DaeSolver::DaeSolver(const SparseMatrix& pattern, const std::vector<std::pair<int, int>>& pairs)
    : condensation_(pattern, pairs), no_rates_(pairs.empty()) {}

bool DaeSolver::factorize(const SparseMatrix& matrix) {
  if (!condensation_.update(matrix)) return false;
  // Systems without rates are small, and dense where there is an arm: nothing is gained by rows without
  // pivots.
  if (no_rates_) return pivot();
  tried_ = by_klu_ = refined_ = false;
  if (!lu_) lu_.emplace(condensation_.matrix());
  return lu_->factorize(condensation_.matrix()) || pivot();
}

bool DaeSolver::pivot() {
  if (!klu_) klu_.emplace(condensation_.matrix());
  ++pivoted_;
  by_klu_ = tried_ = true;
  return klu_->factorize(condensation_.matrix());
}

bool DaeSolver::solve(const SparseMatrix& matrix, Eigen::Ref<Eigen::VectorXd> b) {
  condensation_.reduce(matrix, b, right_);
  solution_ = right_;
  if (!by_klu_ && !solve_without_pivots()) {
    if (!pivot()) return false;
    solution_ = right_;
  }
  if (by_klu_) klu_->solve(solution_);
  condensation_.expand(solution_, b);
  return true;
}

template <bool with_size>
void DaeSolver::find_rest() {
  const SparseMatrix& a = condensation_.matrix();
  rest_ = right_;
  if constexpr (with_size) size_ = right_.cwiseAbs();
  for (int j = 0; j < a.order; ++j) {
    for (int s = a.column_start[at(j)]; s < a.column_start[at(j) + 1]; ++s) {
      const double product = a.value[at(s)] * solution_[j];
      rest_[a.row[at(s)]] -= product;
      if constexpr (with_size) size_[a.row[at(s)]] += std::abs(product);
    }
  }
}

// The first solution is put into the equations, and where that shows lost digits what is left is solved for,
// there and in all later ones.
bool DaeSolver::solve_without_pivots() {
  constexpr double most = 1e-8;
  lu_->solve(solution_);
  const auto refine = [this] {
    lu_->solve(rest_);
    solution_ += rest_;
  };
  if (tried_) {
    if (refined_) {
      find_rest<false>();
      refine();
    }
    return true;
  }
  tried_ = true;
  refined_ = !(backward_error() <= most);
  if (refined_) refine();
  return !refined_ || backward_error() <= most;
}

// max_i |b - A x|_i/(|A| |x| + |b|)_i: the least relative change of A and b that makes x a solution (Oettli
// and Prager 1964). Rows in which nothing happens are left out.
double DaeSolver::backward_error() {
  find_rest<true>();
  const double nothing = 1e-20 * size_.maxCoeff();
  double worst = 0.0;
  for (Eigen::Index i = 0; i < rest_.size(); ++i) {
    if (!std::isfinite(rest_[i])) return std::numeric_limits<double>::infinity();
    if (size_[i] > nothing) worst = std::max(worst, std::abs(rest_[i]) / size_[i]);
  }
  return worst;
}

}  // namespace snare::numerics
