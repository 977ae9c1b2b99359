#include "identification/records/bounded_least_squares.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace snare::identification {

namespace {

// Numbers that hang together need small dampings: along their valley a larger one takes steps of nothing.
constexpr double least_damping = 1e-12, first_damping = 1e-9;
constexpr int most_tries = 12;
constexpr int small_falls_to_end = 2;  // one alone may be a step that was held back

/// Step that lowers |r + J s|^2 + mu |D s|^2 with s on the bounds where it would cross them; `held` numbers do not move.
Eigen::VectorXd step_within(const BoundedProblem& problem, const Eigen::VectorXd& x, const Eigen::VectorXd& r,
                            const Eigen::MatrixXd& J, const std::vector<bool>& held, double damping) {
  const Eigen::Index n = x.size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
  std::vector<bool> fixed = held;
  for (Eigen::Index round = 0; round <= n; ++round) {
    std::vector<Eigen::Index> free;
    Eigen::VectorXd rest = r;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (fixed[static_cast<std::size_t>(k)])
        rest += J.col(k) * step[k];
      else
        free.push_back(k);
    }
    if (free.empty()) return step;
    const auto count = static_cast<Eigen::Index>(free.size());
    // Damped rows under the Jacobian: D are the norms of its columns.
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(J.rows() + count, count);
    rows.topRows(J.rows()) = J(Eigen::all, free);
    for (Eigen::Index k = 0; k < count; ++k)
      rows(J.rows() + k, k) = std::sqrt(damping) * rows.col(k).head(J.rows()).norm();
    Eigen::VectorXd right = Eigen::VectorXd::Zero(rows.rows());
    right.head(J.rows()) = -rest;
    const Eigen::VectorXd solved = rows.colPivHouseholderQr().solve(right);
    bool crossed = false;
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index i = free[static_cast<std::size_t>(k)];
      const double there = std::clamp(x[i] + solved[k], problem.lower[i], problem.upper[i]);
      step[i] = there - x[i];
      if (there != x[i] + solved[k]) fixed[static_cast<std::size_t>(i)] = crossed = true;
    }
    if (!crossed) return step;
  }
  return step;
}

}  // namespace

BoundedResult bounded_least_squares(const BoundedProblem& problem, const Eigen::VectorXd& start, int max_iterations,
                                    double tolerance) {
  BoundedResult result;
  result.x = start.cwiseMax(problem.lower).cwiseMin(problem.upper);
  Eigen::VectorXd r = problem.residual(result.x);
  if (r.size() == 0) {
    result.end = BoundedEnd::no_start;
    return result;
  }
  result.chi2 = r.squaredNorm();
  double damping = first_damping;
  int small_falls = 0;
  while (true) {
    if (problem.progress && !problem.progress(result.iterations, result.chi2)) {
      result.end = BoundedEnd::stopped;
      return result;
    }
    if (result.iterations == max_iterations) {
      result.end = BoundedEnd::iteration_limit;
      return result;
    }
    ++result.iterations;
    const Eigen::MatrixXd J = problem.residual_jacobian(result.x);
    const Eigen::VectorXd slope = J.transpose() * r;
    std::vector<bool> held;
    for (Eigen::Index k = 0; k < slope.size(); ++k)
      held.push_back((result.x[k] <= problem.lower[k] && slope[k] >= 0.0) ||
                     (result.x[k] >= problem.upper[k] && slope[k] <= 0.0) || !(J.col(k).norm() > 0.0));
    // What a whole step promises: at a minimum no simulation is spent on falls that are below those that end the search.
    const Eigen::VectorXd whole = step_within(problem, result.x, r, J, held, least_damping);
    if (result.chi2 - (r + J * whole).squaredNorm() <= tolerance * result.chi2) return result;
    double fall = 0.0;
    for (int attempt = 0; attempt < most_tries && !(fall > 0.0); ++attempt) {
      const Eigen::VectorXd there = result.x + step_within(problem, result.x, r, J, held, damping);
      Eigen::VectorXd next = problem.residual(there.cwiseMax(problem.lower).cwiseMin(problem.upper));
      const double chi2 = next.size() == 0 ? std::numeric_limits<double>::infinity() : next.squaredNorm();
      if (!(chi2 < result.chi2)) {
        damping *= 10.0;
        continue;
      }
      fall = result.chi2 - chi2;
      damping = std::max(0.1 * damping, least_damping);
      result.x = there.cwiseMax(problem.lower).cwiseMin(problem.upper);
      r = std::move(next);
      result.chi2 = chi2;
    }
    small_falls = fall > tolerance * result.chi2 ? 0 : small_falls + 1;
    if (!(fall > 0.0) || small_falls == small_falls_to_end) return result;
  }
}

}  // namespace snare::identification
