#pragma once

#include <Eigen/Core>

#include <functional>

namespace snare::identification {

/// Least squares of a residual r(x) within bounds, by Levenberg and Marquardt's method with an active set:
/// theory.md (I.26). A step that would cross a bound ends on it in that number, and the others are solved for
/// again: where it is left to a line search, numbers that belong together creep along the bound. Derivatives
/// are asked for once and then corrected by what every step shows, (I.28); anew where a step falls short of
/// what they promise, and where they promise no more: no search ends on corrected ones.
struct BoundedProblem {
  Eigen::VectorXd lower, upper;                                     ///< may be infinite
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> residual;  ///< empty: there is none at this place
  std::function<Eigen::MatrixXd(const Eigen::VectorXd&)>
      residual_jacobian;                                     ///< asked where `residual` was last accepted
  std::function<bool(int iteration, double chi2)> progress;  ///< false stops
  /// Derivatives at the start where they are known (moved into the bounds or not): none are asked for there.
  /// Empty: they are asked for.
  Eigen::MatrixXd first_jacobian = {};
  /// Share of the sum that noise lets the numbers take, numbers over readings: where derivatives asked for
  /// promise a tenth of that, one step is taken and the search ends. 0: the sum is no sum of noise.
  double by_chance = 0.0;
};

/// Why the iteration ended.
enum class BoundedEnd {
  converged,  ///< the last step lowered the sum by less than its share `tolerance`, or no step lowers it
  iteration_limit,  ///< it may fall further
  stopped,          ///< by `progress`
  no_start          ///< no residual at the start
};

/// Where it came to.
struct BoundedResult {
  Eigen::VectorXd x;
  Eigen::MatrixXd
      jacobian;       ///< the last one that was used: asked for at x or near it, and corrected on the way
  double chi2 = 0.0;  ///< sum of squares, a number without unit
  int iterations = 0;
  BoundedEnd end = BoundedEnd::converged;
};

/// From a start (x in its units), which is moved into the bounds. tolerance: relative fall of the sum, > 0;
/// max_iterations >= 1.
[[nodiscard]] BoundedResult bounded_least_squares(const BoundedProblem& problem, const Eigen::VectorXd& start,
                                                  int max_iterations, double tolerance);

}  // namespace snare::identification
