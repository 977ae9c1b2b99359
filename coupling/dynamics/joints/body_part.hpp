#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/options.hpp"
#include "numerics/dae.hpp"

#include <vector>

namespace snare::coupling {

/// A rigid body as part of a DAE.                                                       theory.md (M.5)
///   p' = v,  q' = 1/2 q (0, w) + nu q,  |q|^2 = 1,  m v' + c v = F,  I w' + w x I w + c w = T
/// p, v of the centre of mass in the world; w, I and T in the body. A driven body has v = course(t), w = 0
/// instead. nu, which vanishes but for the integrator's error, keeps the quaternion's length.
class BodyPart final : public numerics::DaePart {
 public:
  /// The body stays as given; gravity in the world [m/s^2].
  BodyPart(const MotionBody& body, const Eigen::Vector3d& gravity, const MotionOptions& options);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void rates(std::vector<std::pair<int, int>>& pairs) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  /// Its unknowns that leave a plane across axis `normal` of the world (0 to 2), or turn out of it: see
  /// RodPart.
  [[nodiscard]] std::vector<int> unknowns_across(int normal) const;

  /// Writes the body's start into its places among the unknowns y (SI units).
  void place(Eigen::VectorXd& y) const;
  /// Of a driven body at a time [s].
  [[nodiscard]] Eigen::Vector3d course_velocity(double time) const;      ///< [m/s]
  [[nodiscard]] Eigen::Vector3d course_acceleration(double time) const;  ///< [m/s^2]
  [[nodiscard]] multibody::RigidBodyState state(const numerics::VectorView& y) const;
  [[nodiscard]] const MotionBody& body() const { return body_; }
  [[nodiscard]] bool moves_freely() const { return !body_.driven; }
  /// First unknowns, and rows of the equations above in their order: p_WB, quaternion (w, x, y, z), v, w in
  /// B, nu.
  [[nodiscard]] int position() const { return first_ + Local::position; }
  [[nodiscard]] int quaternion() const { return first_ + Local::quaternion; }
  [[nodiscard]] int velocity() const { return first_ + Local::velocity; }
  [[nodiscard]] int spin() const { return first_ + Local::spin; }
  [[nodiscard]] int length_multiplier() const { return first_ + Local::length; }
  static constexpr int coordinates = 7;  ///< from position() on: place and orientation
  static constexpr int velocities = 6;   ///< from velocity() on, behind the coordinates
  [[nodiscard]] const Eigen::Matrix3d& inverse_inertia() const { return inverse_inertia_; }
  /// Power of the drag, lost [W], and of the constant forces, gained [W].
  [[nodiscard]] double drag_power(const numerics::VectorView& y) const;
  [[nodiscard]] double force_power(const numerics::VectorView& y) const;

 private:
  /// Places of the unknowns and of their rows, from the first on.
  struct Local {
    static constexpr int position = 0, quaternion = 3, velocity = 7, spin = 10, length = 13, count = 14;
  };

  MotionBody body_;
  Eigen::Vector3d force_;
  MotionOptions options_;
  Eigen::Matrix3d inverse_inertia_;
  int first_ = 0;
  std::vector<int> slots_;  // of Local::count rows and columns, row by row
};

}  // namespace snare::coupling
