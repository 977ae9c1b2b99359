#pragma once

#include <Eigen/Core>

namespace snare::identification {

/// Removes from columns their components in the span of a Jacobian. Whitened, so all is dimensionless.
class Projection {
 public:
  explicit Projection(const Eigen::MatrixXd& jacobian);
  /// c - Q Q^T c of every column c [-], Q the basis; as many rows as the Jacobian has.
  [[nodiscard]] Eigen::MatrixXd without(const Eigen::MatrixXd& columns) const;
  /// Orthonormal columns of that span, as many rows as the Jacobian.
  [[nodiscard]] const Eigen::MatrixXd& basis() const { return basis_; }

 private:
  Eigen::MatrixXd basis_;
};

}  // namespace snare::identification
