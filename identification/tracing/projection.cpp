#include "identification/tracing/projection.hpp"

#include <Eigen/SVD>

namespace snare::identification {

Projection::Projection(const Eigen::MatrixXd& jacobian) {
  if (jacobian.cols() == 0) return;
  Eigen::MatrixXd scaled = jacobian;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k) {
    const double norm = scaled.col(k).norm();
    if (norm > 0.0) scaled.col(k) /= norm;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > 1e-9 * svd.singularValues()[0]) ++rank;
  basis_ = svd.matrixU().leftCols(rank);
}

Eigen::MatrixXd Projection::without(const Eigen::MatrixXd& columns) const {
  if (basis_.cols() == 0) return columns;
  return columns - basis_ * (basis_.transpose() * columns);
}

}  // namespace snare::identification
