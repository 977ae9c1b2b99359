// A tree on one free body, its momentum an unknown: the six rows of the base say P(q, v) - h = 0, and h' =
// loads is integrated. The formulas of the integrator keep a constant exactly, so that the momentum errs by
// what Newton's method leaves in the base's rows and does not drift.                         theory.md (A.16)

#include "multibody/arm/arm_part.hpp"

#include "base/index.hpp"

namespace snare::multibody {

namespace {

using base::at;

}  // namespace

void ElasticArmPart::use_momentum(const numerics::DaePoint& point, bool loaded,
                                  Eigen::Ref<Eigen::VectorXd> rows) {
  // Bodies' velocities and poses are those that the inverse dynamics have just left; F_B is free now.
  std::vector<Wrench>& carried = workspace_.F_B;
  for (int i = 0; i < arm_.tree.size(); ++i)
    carried[at(i)] = arm_.tree.body(i).inertia * workspace_.V_B[at(i)];
  for (int i = arm_.tree.size() - 1; i > 0; --i) {
    carried[at(arm_.tree.body(i).parent)] += workspace_.X_PB[at(i)].to_outer(carried[at(i)]);
  }
  rows.segment<6>(v_) = workspace_.X_PB[0].to_outer(carried[0]).vector() - point.y.segment<6>(momentum_);
  rows.segment<6>(momentum_) += point.rate.segment<6>(momentum_);
  if (!loaded) return;
  for (int i = 0; i < arm_.tree.size(); ++i) {
    rows.segment<6>(momentum_) -= kinematics_.X_WB[at(i)].to_outer(wrenches_[at(i)]).vector();
  }
}

void ElasticArmPart::add_momentum_derivatives(double time, double c, std::vector<double>& values) {
  // Takes the place of the base's balance of forces in the derivatives of the inverse dynamics.
  const MomentumDerivatives d = differentiate_momentum(arm_.tree, derivatives_);
  derivatives_.position.topRows<6>() = d.position;
  derivatives_.velocity.topRows<6>() = d.velocity;
  derivatives_.mass.topRows<6>().setZero();
  for (std::size_t i = 0; i < 6; ++i) {
    values[at(slots_.momentum[2 * i])] -= 1.0;
    values[at(slots_.momentum[2 * i + 1])] += c;
  }
  for (const TimedLoad& load : loads_) {
    const double share = load.share(inside(time));
    if (share == 0.0 || arm_.tree.frame(load.frame).body < 0) continue;
    // The moment p x F changes with the point.
    const Matrix6X J = frame_jacobian(arm_.tree, kinematics_, load.frame);
    Eigen::Matrix<double, 3, Eigen::Dynamic> by_motion(3, arm_.tree.velocities());
    for (int j = 0; j < arm_.tree.velocities(); ++j)
      by_motion.col(j) = share * J.col(j).tail<3>().cross(load.peak.force);
    const Eigen::Matrix<double, 3, Eigen::Dynamic> by_coordinates =
        by_motion * coordinate_motion(arm_.tree, q_values_);
    for (int j = 0; j < arm_.tree.coordinates(); ++j) {
      for (int i = 0; i < 3; ++i) values[at(slots_.momentum_by_q[at(3 * j + i)])] -= by_coordinates(i, j);
    }
  }
}

}  // namespace snare::multibody
