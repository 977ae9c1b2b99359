#include "numerics/dae_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::numerics {

DaeSolver::DaeSolver(const SparseMatrix& pattern, const std::vector<std::pair<int, int>>& pairs)
    : condensation_(pattern, pairs), no_rates_(pairs.empty()) {}

bool DaeSolver::factorize(const SparseMatrix& matrix) {
  if (!condensation_.update(matrix)) return false;
  // Systems without rates are small, and dense where there is an arm: nothing is gained by rows without pivots.
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

// The first solution is put into the equations, and where that shows lost digits what is left is solved for, there and in all later ones.
bool DaeSolver::solve_without_pivots() {
  constexpr double most = 1e-8;
  lu_->solve(solution_);
  if (tried_ && !refined_) return true;
  const double error = backward_error(solution_, right_);
  if (!tried_) refined_ = !(error <= most);
  if (refined_) {
    lu_->solve(rest_);
    solution_ += rest_;
  }
  const bool accurate = tried_ || !refined_ || backward_error(solution_, right_) <= most;
  tried_ = true;
  return accurate;
}

// max_i |b - A x|_i/(|A| |x| + |b|)_i: the least relative change of A and b that makes x a solution (Oettli and Prager 1964).
// Rows in which nothing happens are left out.
double DaeSolver::backward_error(const Eigen::VectorXd& x, const Eigen::VectorXd& b) {
  const SparseMatrix& a = condensation_.matrix();
  rest_ = b;
  size_ = b.cwiseAbs();
  for (int j = 0; j < a.order; ++j) {
    for (int s = a.column_start[static_cast<std::size_t>(j)]; s < a.column_start[static_cast<std::size_t>(j) + 1];
         ++s) {
      const double product = a.value[static_cast<std::size_t>(s)] * x[j];
      rest_[a.row[static_cast<std::size_t>(s)]] -= product;
      size_[a.row[static_cast<std::size_t>(s)]] += std::abs(product);
    }
  }
  const double nothing = 1e-20 * size_.maxCoeff();
  double worst = 0.0;
  for (Eigen::Index i = 0; i < rest_.size(); ++i) {
    if (!std::isfinite(rest_[i])) return std::numeric_limits<double>::infinity();
    if (size_[i] > nothing) worst = std::max(worst, std::abs(rest_[i]) / size_[i]);
  }
  return worst;
}

}  // namespace snare::numerics
