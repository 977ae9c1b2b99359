#pragma once

#include "coupling/contact/shape.hpp"
#include "coupling/dynamics/contact/point_tree.hpp"
#include "coupling/dynamics/contact/unilateral_force_part.hpp"
#include "coupling/dynamics/model/body_contact.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace snare::coupling {

template <class S>
struct FrameMotion;

/// Contact of two carriers in a DAE.                                                         theory.md (M.28)
///
/// Friction with bristles adds three unknowns z a point, in the axes of the shape, of which the part in the
/// tangent plane acts:
///   e = z_t + tau w,   f = e min(mu_s p_e/z_m, mu p/|e|),   (p_e + W) z' = p_e dz/dt - W z/t_0
/// with p_e dz/dt by bristle_flow; z forgets its part along the normal as the slider does, and all of it
/// where nothing presses: see BristleMeans.
class BodyContactPart final : public UnilateralForcePart {
 public:
  /// Frames of the shape and of the points.
  BodyContactPart(const BodyContact& contact, MovingFrame shape, MovingFrame points);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;
  /// Where a point's bristle acts that is not in the pattern.
  bool outgrows_pattern(const numerics::DaePoint& at) override;
  void save_state(std::vector<double>& memory) const override;
  void restore_state(const numerics::VectorView& y, std::span<const double>& memory) override;

  /// Whether friction has bristles, three unknowns a point: see bristle_of.
  [[nodiscard]] bool has_bristle() const { return contact_.friction.has_bristle(); }
  /// First of the three of a point; only with bristles.
  [[nodiscard]] int bristle_of(std::size_t point) const { return bristle_ + 3 * static_cast<int>(point); }
  /// dz/dt [m/s] of the bristles into their places of `rate`, at unknowns y in SI units.
  void set_bristle_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const override;
  [[nodiscard]] bool has_body_bristles() const override { return has_bristle(); }
  /// A point of the other pressed into the shape by more than a tenth of its radius would be thrown out.
  [[nodiscard]] std::optional<base::InputProblem> overlap(const numerics::VectorView& y,
                                                          double tolerance) const override;
  /// Touches that began at a start, of which the integrator has no event; stick and slip.
  [[nodiscard]] std::vector<MotionEvent> changes(const numerics::DaePoint& now, double time_before,
                                                 bool event) override;

  [[nodiscard]] std::vector<multibody::Wrench> wrenches(const numerics::VectorView& y) const override;
  [[nodiscard]] double depth(const numerics::VectorView& y) const override;
  [[nodiscard]] double touches(const numerics::VectorView& y) const override;
  [[nodiscard]] bool jumps() const override { return jumps_at_touch(contact_.law); }
  [[nodiscard]] Pressing pressing(const numerics::VectorView& y) const override;

 private:
  using Frames = std::array<FrameMotion<double>, 2>;
  using Inside = std::vector<std::pair<std::size_t, DistanceField>>;
  [[nodiscard]] std::vector<int> inner(const numerics::VectorView& y) const override;
  [[nodiscard]] Eigen::MatrixXd derivatives(const numerics::VectorView& y) const override;
  [[nodiscard]] Eigen::Vector3d bristle(const numerics::VectorView& y, std::size_t point) const;
  /// What each point inside does.
  struct Acting;
  [[nodiscard]] std::vector<Acting> acting(const Frames& now, const numerics::VectorView& y) const;
  [[nodiscard]] Eigen::VectorXd bristle_rates(const std::vector<Acting>& acting,
                                              const numerics::VectorView& y) const;
  /// A point of the other's frame in the frame of the shape.
  [[nodiscard]] static Eigen::Vector3d in_shape(const Frames& now, const Eigen::Vector3d& point);
  /// The points that are in the shape, in their order, with its field there.
  [[nodiscard]] Inside points_inside(const Frames& now) const;

  BodyContact contact_;
  PointTree tree_;
  int bristle_ = 0;
  std::vector<bool> coupled_;  // points in the pattern
  /// How it was at the last accepted step.
  struct Seen {
    bool closed = false, sticking = false;
  };
  Seen seen_;
};

}  // namespace snare::coupling
