#pragma once

#include "coupling/dynamics/constraint.hpp"
#include "wire/rod_part.hpp"

#include <vector>

namespace snare::coupling {

/// One end of a wire held by a frame that moves.                                             theory.md (M.17)
///
///   x - p_WM = 0,  v - v_M = 0
/// x, v: the end vertex; M: the mount's frame, its x axis the direction of increasing arc length, its y axis the director.
/// The force f on the vertex is a multiplier, stabilised by another one in x' = v + mu; the carrier gets -f, and the
/// moment of the half cell beside the mount. The wire is discretised as between mounts that stand still.
class MountPart final : public Constraint {
 public:
  /// Lets the end of the rod be carried: before the rod declares its unknowns.
  MountPart(std::string name, MovingFrame mount, wire::RodPart& rod, wire::End end, const MotionOptions& options);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  /// After the rod's own.
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  [[nodiscard]] int constraints() const override { return 3; }
  [[nodiscard]] Eigen::VectorXd velocity_error(const numerics::VectorView& y, const Eigen::VectorXd& dv) const override;
  /// Constraint: -(dJ_M/dt) v of the carrier, what v - v_M changes by while the velocities stay [m/s^2].
  [[nodiscard]] Eigen::VectorXd acceleration_bias(const numerics::VectorView& y,
                                                  const Eigen::VectorXd& rate) const override;
  /// Constraint: f/m of the end vertex, m its inertia, and what -f does to a carrier that moves freely.
  void apply_impulse(const numerics::VectorView& y, const Eigen::VectorXd& multipliers,
                     Eigen::VectorXd& dv) const override;
  /// Force on the wire's end; no moment: see `moment`.
  [[nodiscard]] multibody::Wrench wrench(const numerics::VectorView& y) const override;
  /// Of the wire on the mount, at the point of the rod's last evaluation [N m].
  [[nodiscard]] Eigen::Vector3d moment(const numerics::DaePoint& at) const { return rod_.mount_moment(at, end_); }
  [[nodiscard]] const wire::RodPart& rod() const { return rod_; }
  [[nodiscard]] wire::End end() const { return end_; }
  /// Distance of the end from its mount [m].
  [[nodiscard]] double gap(const numerics::VectorView& y) const override;

 private:
  /// Unknowns of the half cell (wire::MountCell): vertex at the mount, next vertex, angle of the edge between; and
  /// the rows of their balances, which for the vertices are the unknowns v too.
  [[nodiscard]] std::vector<int> places() const;
  [[nodiscard]] std::vector<int> balances() const;
  void append_curvatures(std::vector<int>& list) const;
  [[nodiscard]] int vertex() const { return rod_.model().vertex_at(end_); }

  // First of three multipliers each, and of the rows of the same index: place and velocity of the end.
  [[nodiscard]] int force() const { return multipliers(); }
  [[nodiscard]] int stabiliser() const { return stabiliser_; }

  wire::RodPart& rod_;
  wire::End end_;
  int stabiliser_ = 0;
};

}  // namespace snare::coupling
