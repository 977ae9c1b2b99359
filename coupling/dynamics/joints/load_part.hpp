#pragma once

#include "coupling/dynamics/joints/moving_frame.hpp"
#include "coupling/dynamics/model/frame_load.hpp"
#include "numerics/dae.hpp"

#include <utility>
#include <vector>

namespace snare::coupling {

/// A load over time in a DAE: no unknowns, a wrench on one carrier.                          theory.md (M.29)
class LoadPart final : public numerics::DaePart {
 public:
  LoadPart(const FrameLoad& load, MovingFrame frame) : load_(load), frame_(std::move(frame)) {}

  void declare(numerics::DaeLayout& /*layout*/) override {}
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override { slots_.attach(pattern); }
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  /// About the frame's origin, in the axes of the world.
  [[nodiscard]] multibody::Wrench wrench(const numerics::DaePoint& at) const;
  [[nodiscard]] const MovingFrame& frame() const { return frame_; }
  /// The first of its times behind a time, at which the integration must stop [s]; infinite: none.
  [[nodiscard]] double next_break(double time) const;
  /// The integration has come to a time [s]; true: it must begin anew there, behind one of the load's times.
  [[nodiscard]] bool begin_interval(double time);

 private:
  FrameLoad load_;
  MovingFrame frame_;
  double entered_ = 0.0;
  numerics::PatternSlots slots_;
};

}  // namespace snare::coupling
