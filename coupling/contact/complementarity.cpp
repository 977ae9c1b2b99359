#include "coupling/contact/complementarity.hpp"

#include <Eigen/QR>

#include <vector>

namespace snare::coupling {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd complementary_impulses(const MatrixXd& a, const VectorXd& b, const VectorXd& pull) {
  const Eigen::Index n = b.size();
  std::vector<bool> pushes(static_cast<std::size_t>(n), true);
  VectorXd p = VectorXd::Zero(n);
  // What a contact that does not push may approach with: round-off of the sums.
  const double slack = 1e-12 * (1.0 + b.cwiseAbs().maxCoeff());
  constexpr int rounds_each = 50;  // far more than a few contacts take
  for (Eigen::Index round = 0; round < rounds_each * n; ++round) {
    std::vector<Eigen::Index> active;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (pushes[static_cast<std::size_t>(i)]) active.push_back(i);
    }
    p.setZero();
    if (!active.empty()) {
      const VectorXd solution =
          MatrixXd(a(active, active)).completeOrthogonalDecomposition().solve(VectorXd(-b(active)));
      p(active) = solution;
    }
    const VectorXd w = a * p + b;
    bool settled = true;
    for (Eigen::Index i = 0; i < n && settled; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (pushes[k] ? p[i] < -pull[i] : w[i] < -slack) {
        pushes[k] = !pushes[k];
        settled = false;
      }
    }
    if (settled) break;
  }
  return p;
}

}  // namespace snare::coupling
