#include "identification/tracing/projection.hpp"

#include "numerics/dense_solvers.hpp"

namespace snare::identification {

Projection::Projection(const Eigen::MatrixXd& jacobian) {
  basis_.resize(jacobian.rows(), 0);
  if (jacobian.cols() == 0) return;
  Eigen::MatrixXd scaled = jacobian;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k) {
    const double norm = scaled.col(k).norm();
    if (norm > 0.0) scaled.col(k) /= norm;
  }
  const numerics::ThinSvd svd = numerics::thin_svd(scaled);
  Eigen::Index rank = 0;
  while (rank < svd.s.size() && svd.s[rank] > 1e-9 * svd.s[0]) ++rank;
  basis_ = svd.U.leftCols(rank);
}

Eigen::MatrixXd Projection::without(const Eigen::MatrixXd& columns) const {
  if (basis_.cols() == 0) return columns;
  return columns - basis_ * (basis_.transpose() * columns);
}

}  // namespace snare::identification
