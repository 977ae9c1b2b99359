#pragma once

#include <Eigen/Core>

namespace snare::coupling {

/// Impulses or forces of contacts that push and never pull:  P >= 0,  w = A P + b >= 0,  P.w = 0.      theory.md (M.10)
/// A: symmetric, positive semidefinite flexibility; b: normal speeds or accelerations without P. Principal pivoting by the least index
/// (Murty 1974), finite for positive definite A; of dependent contacts the smallest P. `pull`: a P down to -pull counts as 0.
[[nodiscard]] Eigen::VectorXd complementary_impulses(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                                     const Eigen::VectorXd& pull);

}  // namespace snare::coupling
