#pragma once

#include <Eigen/Core>

#include <functional>
#include <string>

namespace snare::test {

/// Derivatives beside central differences.
struct DerivativeError {
  double relative = 0.0;  ///< largest |analytic - difference| over the largest |analytic| entry [-]
  double step = 0.0;      ///< of the sweep, with the smallest error
  std::string worst;      ///< the worst entry with both values
};

/// Compares `analytic` (rows: components of f, columns: unknowns) with fourth-order central differences of f
/// at x over a sweep of steps 1e-1 to 1e-5 times `scale`; the best step counts, for all entries at once.
///
/// Error of the differences: h^4 of truncation, 1e-16/h of round-off; about 1e-12 at the best step when
/// values and derivatives are of order one, so scale the problem to that.
[[nodiscard]] DerivativeError compare_jacobian(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f, const Eigen::VectorXd& x,
    const Eigen::MatrixXd& analytic, double scale = 1.0);

/// The same for a scalar function and its gradient.
[[nodiscard]] DerivativeError compare_gradient(const std::function<double(const Eigen::VectorXd&)>& f,
                                               const Eigen::VectorXd& x, const Eigen::VectorXd& analytic,
                                               double scale = 1.0);

/// The symmetric part of the Jacobian of a gradient beside a Hessian: for gradients taken in frames that
/// travel, whose Jacobian has a skew part (the holonomy of parallel transport).
[[nodiscard]] DerivativeError compare_symmetric_part(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& gradient, const Eigen::VectorXd& x,
    const Eigen::MatrixXd& hessian, double scale = 1.0);

}  // namespace snare::test
