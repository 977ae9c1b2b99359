#pragma once

#include "coupling/dynamics/moving_frame.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace snare::coupling {

/// A constraint that holds at all times, as the start and the impulses see it: G(q) v = 0.
class Constraint {
 public:
  Constraint() = default;
  virtual ~Constraint() = default;
  Constraint(const Constraint&) = delete;
  Constraint& operator=(const Constraint&) = delete;

  [[nodiscard]] virtual int constraints() const = 0;
  /// G dv of changes of the velocities (or of accelerations).
  [[nodiscard]] virtual Eigen::VectorXd velocity_error(const numerics::VectorView& y,
                                                  const Eigen::VectorXd& dv) const = 0;
  /// d(G v)/dt along the rates of the coordinates, with the velocities as they are.
  [[nodiscard]] virtual Eigen::VectorXd acceleration_bias(const numerics::VectorView& y,
                                              const Eigen::VectorXd& rate) const = 0;
  /// Adds M^-1 G^T times the multipliers.
  virtual void apply_impulse(const numerics::VectorView& y, const Eigen::VectorXd& multipliers,
                       Eigen::VectorXd& dv) const = 0;
  /// First of the multipliers among the unknowns.
  [[nodiscard]] virtual int multipliers() const = 0;
  /// Wrench on what is held, about its held frame's origin, in the axes of the world.
  [[nodiscard]] virtual multibody::Wrench wrench(const numerics::VectorView& y) const = 0;
  /// What holds it.
  [[nodiscard]] virtual const MovingFrame& carrier() const = 0;
};

/// Adds to dv what the links' forces do, so that G dv + extra = 0 for all of them; returns their multipliers, link by
/// link. extra: empty for zero.                                                            theory.md (M.16)
Eigen::VectorXd project(const std::vector<const Constraint*>& links, const numerics::VectorView& y,
                           const Eigen::VectorXd& extra, Eigen::VectorXd& dv);

/// A body welded to a frame of another body, of an arm or of the world.                     theory.md (M.15)
///
///   p_WB = p_WA,  sum_k a_k x b_k / 2 = 0  (axes a_k of A, b_k of B),  v_B = v_A,  w_B = w_A
/// with the wrench (M, F) on B and -(M, F) on A as multipliers; stabilised in the manner of Gear, Gupta and Leimkuhler by
/// six more in the kinematics of the held body alone: p' = v + mu_p, q' = 1/2 q (0, w + mu_w).
class WeldPart final : public numerics::DaePart, public Constraint {
 public:
  /// A: the carrier's frame; B: X_BH of the held body's, driven or not by forces alone.
  WeldPart(std::string name, MovingFrame carrier, const BodyPart& held, const multibody::Pose& X_BH,
           const MotionOptions& options);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override { pattern_ = &pattern; }
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  [[nodiscard]] int constraints() const override { return 6; }
  [[nodiscard]] Eigen::VectorXd velocity_error(const numerics::VectorView& y,
                                          const Eigen::VectorXd& dv) const override;
  [[nodiscard]] Eigen::VectorXd acceleration_bias(const numerics::VectorView& y,
                                      const Eigen::VectorXd& rate) const override;
  void apply_impulse(const numerics::VectorView& y, const Eigen::VectorXd& multipliers,
               Eigen::VectorXd& dv) const override;
  [[nodiscard]] int multipliers() const override { return first_; }
  [[nodiscard]] multibody::Wrench wrench(const numerics::VectorView& y) const override;
  [[nodiscard]] const MovingFrame& carrier() const override { return carrier_; }
  /// Distance [m] and angle [rad] by which the frames are apart.
  [[nodiscard]] double gap(const numerics::VectorView& y) const;

 private:
  std::string name_;
  MovingFrame carrier_;
  MovingFrame held_;
  const BodyPart& body_;
  MotionOptions options_;
  int first_ = 0;
  const numerics::SparseMatrix* pattern_ = nullptr;
};

}  // namespace snare::coupling
