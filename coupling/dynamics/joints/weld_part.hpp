#pragma once

#include "coupling/dynamics/joints/constraint.hpp"

namespace snare::coupling {

/// A frame H of a body B welded to a frame A of another body, of an arm or of the world.    theory.md (M.15)
///
///   sum_k a_k x h_k / 2 = 0  (axes a_k of A, h_k of H),   p_WH - p_WA = 0;   w_H - w_A = 0,  v_H - v_A = 0
/// with the wrench (M, F) on B about H's origin, and -(M, F) on the carrier of A, as multipliers; stabilised
/// by six more in the kinematics of the held body alone: p' = v + mu_p, q' = 1/2 q (0, w + mu_w), mu_w in B.
class WeldPart final : public Constraint {
 public:
  /// carrier: A. X_BH: of H in the held body, which moves freely.
  WeldPart(std::string name, MovingFrame carrier, const BodyPart& held, const multibody::Pose& X_BH,
           const MotionOptions& options);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  [[nodiscard]] int constraints() const override { return 6; }
  [[nodiscard]] Eigen::VectorXd velocity_error(const numerics::VectorView& y,
                                               const Eigen::VectorXd& dv) const override;
  /// Constraint: what w_H - w_A and v_H - v_A change by while the velocities stay [rad/s^2, m/s^2].
  [[nodiscard]] Eigen::VectorXd acceleration_bias(const numerics::VectorView& y,
                                                  const Eigen::VectorXd& rate) const override;
  /// Constraint: what the wrench does to the held body, and the opposite one to a carrier that moves freely.
  void apply_impulse(const numerics::VectorView& y, const Eigen::VectorXd& multipliers,
                     Eigen::VectorXd& dv) const override;
  [[nodiscard]] multibody::Wrench wrench(const numerics::VectorView& y) const override;
  [[nodiscard]] double gap(const numerics::VectorView& y) const override;

 private:
  // First of three multipliers each, and of the rows of the same index: turn, place, angular and linear
  // velocity.
  [[nodiscard]] int moment() const { return multipliers(); }
  [[nodiscard]] int force() const { return multipliers() + 3; }
  [[nodiscard]] int turn_stabiliser() const { return stabiliser_; }
  [[nodiscard]] int shift_stabiliser() const { return stabiliser_ + 3; }

  MovingFrame held_;
  const BodyPart& body_;
  int stabiliser_ = 0;
};

}  // namespace snare::coupling
