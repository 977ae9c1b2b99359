#pragma once

#include "coupling/dynamics/weld_part.hpp"
#include "wire/rod_dynamics.hpp"

#include <vector>

namespace snare::coupling {

/// One end of a wire held by a frame that moves.                                             theory.md (M.17)
///
///   x = p_WM,  v = v_M;  the frame's x axis is the mount's direction of increasing arc length, its y axis the director
/// The force on the end vertex is a multiplier, stabilised by another one in x' = v + mu; the moment of the half cell
/// beside the mount acts on the frame. The wire is discretised as between mounts that stand still.
class MountPart final : public numerics::DaePart, public Constraint {
 public:
  /// Lets the end of the rod be carried: before the rod declares its unknowns.
  MountPart(std::string name, MovingFrame mount, wire::RodPart& rod, bool right,
            const MotionOptions& options);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override { pattern_ = &pattern; }
  /// After the rod's own.
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  [[nodiscard]] int constraints() const override { return 3; }
  [[nodiscard]] Eigen::VectorXd velocity_error(const numerics::VectorView& y,
                                          const Eigen::VectorXd& dv) const override;
  [[nodiscard]] Eigen::VectorXd acceleration_bias(const numerics::VectorView& y,
                                      const Eigen::VectorXd& rate) const override;
  void apply_impulse(const numerics::VectorView& y, const Eigen::VectorXd& multipliers,
               Eigen::VectorXd& dv) const override;
  [[nodiscard]] int multipliers() const override { return first_; }
  /// Force on the wire's end; no moment: see `moment`.
  [[nodiscard]] multibody::Wrench wrench(const numerics::VectorView& y) const override;
  /// Of the wire on the mount, at the point of the rod's last evaluation [N m].
  [[nodiscard]] Eigen::Vector3d moment(const numerics::DaePoint& at) const {
    return rod_.mount_moment(at, right_);
  }
  [[nodiscard]] const MovingFrame& carrier() const override { return mount_; }
  [[nodiscard]] const wire::RodPart& rod() const { return rod_; }
  [[nodiscard]] bool right() const { return right_; }
  /// Distance of the end from its mount [m].
  [[nodiscard]] double gap(const numerics::VectorView& y) const;

 private:
  /// Unknowns of the end: vertex at the mount, next vertex, angle; and the rows of their balances.
  [[nodiscard]] std::vector<int> places() const;
  [[nodiscard]] std::vector<int> balances() const;
  [[nodiscard]] int vertex() const { return right_ ? rod_.vertices() - 1 : 0; }

  std::string name_;
  MovingFrame mount_;
  wire::RodPart& rod_;
  bool right_;
  MotionOptions options_;
  int first_ = 0;
  const numerics::SparseMatrix* pattern_ = nullptr;
};

}  // namespace snare::coupling
