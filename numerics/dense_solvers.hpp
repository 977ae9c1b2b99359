#pragma once

#include <Eigen/Core>

/// Decompositions of dense matrices, compiled once: in every source that uses them they take seconds.
namespace snare::numerics {

/// Eigenvalues of a symmetric matrix, rising, and its eigenvectors in the same order. Of any unit.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);

/// Eigenvalues of any square matrix and its eigenvectors in the same order, of norm one. Of any unit.
struct GeneralEigen {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};
[[nodiscard]] GeneralEigen general_eigen(const Eigen::MatrixXd& a);

/// a = U diag(s) V^T with as many columns of U and V as a has rows or columns, whichever are fewer; s falls.
/// Of any unit.
struct ThinSvd {
  Eigen::MatrixXd U;
  Eigen::VectorXd s;
  Eigen::MatrixXd V;
};
[[nodiscard]] ThinSvd thin_svd(const Eigen::MatrixXd& a);

/// x of a x = b for a square matrix, by LU with partial pivots; columns of b are right sides. Of any unit;
/// not finite where a is singular.
[[nodiscard]] Eigen::MatrixXd solve_by_lu(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// x of a x = b for a symmetric matrix, by LDL^T. Of any unit.
[[nodiscard]] Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Pseudo-inverse, by the complete orthogonal decomposition. Of any unit.
[[nodiscard]] Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

/// x of least |a x - b|, and among them the one of least norm; by the same decomposition. Of any unit.
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// x of least |a x - b| for a matrix of full rank, by Householder's QR decomposition with column pivoting. Of
/// any unit.
[[nodiscard]] Eigen::VectorXd full_rank_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace snare::numerics
