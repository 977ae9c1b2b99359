#include "coupling/dynamics/joints/constraint.hpp"

#include "numerics/dense_solvers.hpp"

namespace snare::coupling {

using Eigen::VectorXd;
using numerics::VectorView;

// With the multipliers l: dv' = dv + M^-1 G^T l and G dv' + extra = 0, so that (G M^-1 G^T) l = -(G dv +
// extra). The flexibility G M^-1 G^T is made column by column, from the impulse of each multiplier alone.
VectorXd project(const std::vector<const Constraint*>& constraints, const VectorView& y,
                 const VectorXd& extra, VectorXd& dv) {
  Eigen::Index n = 0;
  for (const Constraint* c : constraints) n += c->constraints();
  if (n == 0) return {};
  const auto velocity_error = [&](const VectorXd& change, auto&& out) {
    Eigen::Index first = 0;
    for (const Constraint* c : constraints) {
      out.segment(first, c->constraints()) = c->velocity_error(y, change);
      first += c->constraints();
    }
  };
  VectorXd missing(n);
  velocity_error(dv, missing);
  if (extra.size() > 0) missing += extra;
  Eigen::MatrixXd flexibility(n, n);
  Eigen::Index column = 0;
  for (const Constraint* c : constraints) {
    for (int k = 0; k < c->constraints(); ++k) {
      VectorXd unit = VectorXd::Zero(y.size());
      c->apply_impulse(y, VectorXd::Unit(c->constraints(), k), unit);
      velocity_error(unit, flexibility.col(column++));
    }
  }
  VectorXd multipliers = -numerics::solve_by_lu(flexibility, missing);
  Eigen::Index first = 0;
  for (const Constraint* c : constraints) {
    c->apply_impulse(y, multipliers.segment(first, c->constraints()), dv);
    first += c->constraints();
  }
  return multipliers;
}

}  // namespace snare::coupling
