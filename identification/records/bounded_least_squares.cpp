#include "identification/records/bounded_least_squares.hpp"

#include "numerics/dense_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace snare::identification {

namespace {

// Numbers that hang together need small dampings: along their valley a larger one takes steps of nothing.
constexpr double least_damping = 1e-12, first_damping = 1e-9;
constexpr double most_damping = 1e6;
// of a step that failed, in what it promises to change: what differs less fails as well
constexpr double another = 0.3;
constexpr int most_tries = 12;
// of the fall by chance: a third of a standard error, and a step leads nearer
constexpr double next_to_minimum = 0.1;
constexpr int small_falls_to_end = 2;  // one alone may be a step that was held back
constexpr double poor_fall = 0.5;  // of what was promised: the derivatives are no longer those of this place

/// Broyden's correction, row by row: the least change, in columns over their norms, with which J tells what
/// the step has shown. What is nought stays
/// so: a reading that does not hang on a number. A row is left as it is where hardly anything moved on which
/// it hangs.
///                                                                                           theory.md (I.28)
void correct(Eigen::MatrixXd& J, const Eigen::VectorXd& step, const Eigen::VectorXd& change) {
  constexpr double hardly = 1e-4;
  const Eigen::VectorXd weighed = J.colwise().squaredNorm().transpose().cwiseProduct(step);
  const double size = weighed.dot(step);
  const Eigen::VectorXd missing = change - J * step;
  for (Eigen::Index i = 0; i < J.rows(); ++i) {
    double own = 0.0;
    for (Eigen::Index k = 0; k < J.cols(); ++k)
      if (J(i, k) != 0.0) own += weighed[k] * step[k];
    if (!(own > hardly * size)) continue;
    for (Eigen::Index k = 0; k < J.cols(); ++k)
      if (J(i, k) != 0.0) J(i, k) += missing[i] * weighed[k] / own;
  }
}

/// Step that lowers |r + J s|^2 + mu |D s|^2 with s on the bounds where it would cross them; `held` numbers
/// do not move.
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
    const Eigen::VectorXd solved = numerics::full_rank_least_squares(rows, right);
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

BoundedResult bounded_least_squares(const BoundedProblem& problem, const Eigen::VectorXd& start,
                                    int max_iterations, double tolerance) {
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
  Eigen::MatrixXd& J = result.jacobian = problem.first_jacobian;
  bool asked = false;  // for the derivatives here, which are then those of this place
  while (true) {
    if (problem.progress && !problem.progress(result.iterations, result.chi2)) {
      result.end = BoundedEnd::stopped;
      return result;
    }
    if (result.iterations == max_iterations) {
      result.end = BoundedEnd::iteration_limit;
      return result;
    }
    if (J.cols() == 0) {
      J = problem.residual_jacobian(result.x);
      asked = true;
    }
    const Eigen::VectorXd slope = J.transpose() * r;
    std::vector<bool> held;
    for (Eigen::Index k = 0; k < slope.size(); ++k)
      held.push_back((result.x[k] <= problem.lower[k] && slope[k] >= 0.0) ||
                     (result.x[k] >= problem.upper[k] && slope[k] <= 0.0) || !(J.col(k).norm() > 0.0));
    // What a whole step promises: at a minimum no simulation is spent on falls that are below those that end
    // the search.
    const Eigen::VectorXd whole = step_within(problem, result.x, r, J, held, least_damping);
    const double whole_fall = result.chi2 - (r + J * whole).squaredNorm();
    if (whole_fall <= tolerance * result.chi2) {
      if (asked) return result;
      J.resize(0, 0);
      continue;
    }
    const bool last_step = asked && whole_fall <= next_to_minimum * problem.by_chance * result.chi2;
    ++result.iterations;
    double fall = 0.0, promised = 0.0;
    const Eigen::VectorXd norms = J.colwise().norm().transpose();
    Eigen::VectorXd failed = Eigen::VectorXd::Zero(norms.size());
    for (int attempt = 0; attempt < (asked ? most_tries : 1) && !(fall > 0.0); ++attempt) {
      Eigen::VectorXd there, step;
      while (damping <= most_damping) {  // to a step that is another than the one that failed
        const Eigen::VectorXd moved = result.x + step_within(problem, result.x, r, J, held, damping);
        there = moved.cwiseMax(problem.lower).cwiseMin(problem.upper);
        step = there - result.x;
        if (attempt == 0 ||
            norms.cwiseProduct(step - failed).norm() > another * norms.cwiseProduct(failed).norm())
          break;
        damping *= 10.0;
      }
      if (step.size() == 0) break;  // damped to nothing
      promised = result.chi2 - (r + J * step).squaredNorm();
      if (promised <= tolerance * result.chi2) break;  // worth no simulation
      Eigen::VectorXd next = problem.residual(there);
      const double chi2 = next.size() == 0 ? std::numeric_limits<double>::infinity() : next.squaredNorm();
      if (!(chi2 < result.chi2)) {
        failed = step;
        damping *= 10.0;
        continue;
      }
      fall = result.chi2 - chi2;
      damping = std::max(0.1 * damping, least_damping);
      correct(J, step, next - r);
      result.x = there;
      r = std::move(next);
      result.chi2 = chi2;
    }
    if (fall > 0.0) {
      small_falls = fall > tolerance * result.chi2 || !asked ? 0 : small_falls + 1;
      if (last_step || small_falls == small_falls_to_end) return result;
      if (fall < poor_fall * promised || fall <= tolerance * result.chi2) J.resize(0, 0);
      asked = false;
      continue;
    }
    if (asked) return result;
    J.resize(0, 0);
  }
}

}  // namespace snare::identification
