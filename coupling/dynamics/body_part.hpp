#pragma once

#include "coupling/dynamics/motion.hpp"

namespace snare::coupling {

/// A rigid body as part of a DAE.                                                       theory.md (M.5)
///   p' = v,  q' = 1/2 q (0, w) + nu q,  |q|^2 = 1,  m v' + c v = F,  I w' + w x I w + c w = T
/// nu, which vanishes but for the integrator's error, keeps the quaternion's length.
class BodyPart final : public numerics::DaePart {
 public:
  BodyPart(const MotionBody& body, const Eigen::Vector3d& gravity, const MotionOptions& options);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  void place(Eigen::VectorXd& y) const;
  /// Of a driven body at a time [s].
  [[nodiscard]] Eigen::Vector3d course_velocity(double time) const;      ///< [m/s]
  [[nodiscard]] Eigen::Vector3d course_acceleration(double time) const;  ///< [m/s^2]
  [[nodiscard]] multibody::RigidBodyState state(const numerics::VectorView& y) const;
  [[nodiscard]] const MotionBody& body() const { return body_; }
  [[nodiscard]] bool moves_freely() const { return !body_.driven; }
  /// First unknowns: p_WB, quaternion (w, x, y, z), v, w in B.
  [[nodiscard]] int position() const { return first_; }
  [[nodiscard]] int quaternion() const { return first_ + 3; }
  [[nodiscard]] int velocity() const { return first_ + 7; }
  [[nodiscard]] int spin() const { return first_ + 10; }
  [[nodiscard]] int length_multiplier() const { return first_ + 13; }
  [[nodiscard]] const Eigen::Matrix3d& inverse_inertia() const { return inverse_inertia_; }
  /// Power of the drag, lost [W], and of the constant forces, gained [W].
  [[nodiscard]] double drag_power(const numerics::VectorView& y) const;
  [[nodiscard]] double force_power(const numerics::VectorView& y) const;

 private:
  MotionBody body_;
  Eigen::Vector3d force_;
  MotionOptions options_;
  Eigen::Matrix3d inverse_inertia_;
  int first_ = 0;
  std::vector<int> slots_;  // 14 x 14
};

}  // namespace snare::coupling
