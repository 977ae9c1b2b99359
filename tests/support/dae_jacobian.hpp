#pragma once

#include "numerics/dae.hpp"
#include "tests/support/derivatives.hpp"
#include "tests/support/sparse_product.hpp"

#include <vector>

namespace snare::test {

/// Every unknown alone, but those of the unit quaternions that begin at `quaternions` along their sphere, as
/// they move: columns of an (n, n) matrix.
[[nodiscard]] Eigen::MatrixXd along_unit_quaternions(const Eigen::VectorXd& y,
                                                     const std::vector<int>& quaternions);

/// The Jacobian dF/dy + c dF/dy' of a system at time 0, along the columns of `directions` (admissible motions
/// of the unknowns), beside differences of F(0, y + D s, y' + c D s) over steps of `scale`.
[[nodiscard]] DerivativeError compare_dae_jacobian(numerics::DaeSystem& system, const Eigen::VectorXd& y,
                                                   const Eigen::VectorXd& rate,
                                                   const Eigen::MatrixXd& directions, double scale);

}  // namespace snare::test
