#pragma once

#include "coupling/dynamics/joints/moving_frame.hpp"
#include "multibody/spatial.hpp"
#include "numerics/dae.hpp"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace snare::coupling {

/// A law between frames of several carriers, in a DAE: a wrench on every carrier.            theory.md (M.26)
///
/// The law says what it does to each frame and how that changes; how frames depend on the unknowns, and rows
/// on wrenches, is here:
///   r -= J_k^T W_k,   dr = -J_i^T dW_i - (dJ_i)^T W_i,
///     dW_i = sum_k D_ik (turn_k, shift_k, spin_k, velocity_k)
/// A law may have unknowns z of its own, with rows z' - rate = 0: `inner` names those that act on the frames.
class FrameForces : public numerics::DaePart {
 public:
  explicit FrameForces(std::vector<MovingFrame> frames) : frames_(std::move(frames)) {}

  void declare(numerics::DaeLayout& /*layout*/) override {}
  /// DaePart: entries are those of the carriers' rows of force by the places and velocities of all frames.
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  /// Frames on which it acts, in the order of `wrenches`.
  [[nodiscard]] const std::vector<MovingFrame>& frames() const { return frames_; }
  /// On every frame, about its origin, in the axes of the world [N m, N]; empty while the law does nothing. y
  /// in SI units.
  [[nodiscard]] virtual std::vector<multibody::Wrench> wrenches(const numerics::VectorView& y) const = 0;
  /// What it stores [J], and loses [W], at unknowns y in SI units.
  struct Power {
    double energy = 0.0;
    double lost = 0.0;
  };
  /// Both at once, y in SI units.
  struct Work {
    std::vector<multibody::Wrench> wrenches;
    Power power;
  };
  [[nodiscard]] virtual Work work(const numerics::VectorView& y) const = 0;

 protected:
  static constexpr int wrench_rows = 6;      // moment, force
  static constexpr int motion_columns = 12;  // turn, shift, angular velocity, velocity of the origin
  /// Unknowns of the law's own that act on the frames at y, or that the frames act on; in the order in which
  /// `derivatives` has them.
  [[nodiscard]] virtual std::vector<int> inner(const numerics::VectorView& /*y*/) const { return {}; }
  /// D: (6 x frames + inner, 12 x frames + inner), of the wrenches and the rates of the inner unknowns; asked
  /// for only where there are wrenches.
  [[nodiscard]] virtual Eigen::MatrixXd derivatives(const numerics::VectorView& y) const = 0;
  [[nodiscard]] numerics::PatternSlots& slots() { return slots_; }

 private:
  /// Who carries frames, with the unknowns on which they depend.
  struct Carrier {
    std::vector<std::size_t> frames;
    std::vector<int> coordinates, velocities;
    bool moves_freely = false;
  };

  std::vector<MovingFrame> frames_;
  std::vector<Carrier> carriers_;
  numerics::PatternSlots slots_;
};

}  // namespace snare::coupling
