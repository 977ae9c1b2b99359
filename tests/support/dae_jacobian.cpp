#include "tests/support/dae_jacobian.hpp"

namespace snare::test {

Eigen::MatrixXd along_unit_quaternions(const Eigen::VectorXd& y, const std::vector<int>& quaternions) {
  Eigen::MatrixXd directions = Eigen::MatrixXd::Identity(y.size(), y.size());
  for (const int first : quaternions) {
    const Eigen::Vector4d q = y.segment<4>(first);
    directions.block<4, 4>(first, first) -= q * q.transpose();
  }
  return directions;
}

DerivativeError compare_dae_jacobian(numerics::DaeSystem& system, const Eigen::VectorXd& y,
                                     const Eigen::VectorXd& rate, const Eigen::MatrixXd& directions,
                                     double scale) {
  constexpr double c = 50.0;
  const numerics::SparseMatrix& sparse = system.jacobian({0.0, y, rate}, c);
  Eigen::MatrixXd analytic(y.size(), y.size());
  for (Eigen::Index j = 0; j < y.size(); ++j) analytic.col(j) = sparse * Eigen::VectorXd(directions.col(j));
  const auto f = [&](const Eigen::VectorXd& s) {
    Eigen::VectorXd rows(y.size());
    const Eigen::VectorXd moved = y + directions * s;
    const Eigen::VectorXd moved_rate = rate + c * (directions * s);
    system.residual({0.0, moved, moved_rate}, rows);
    return rows;
  };
  return compare_jacobian(f, Eigen::VectorXd::Zero(y.size()), analytic, scale);
}

}  // namespace snare::test
