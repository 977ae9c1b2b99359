#pragma once

#include "coupling/dynamics/bushing.hpp"
#include "coupling/dynamics/moving_frame.hpp"
#include "numerics/dae.hpp"

#include <Eigen/Core>

#include <array>
#include <utility>
#include <vector>

namespace snare::coupling {

/// A bushing in a DAE: no unknowns, a wrench on either carrier.                                       theory.md (M.22)
///
///   d = R_A^T (p_B - p_A),  phi = log(R_A^T R_B):   F = -(K d + C d'),  M = -(J^-T(phi) K_r phi + C_r w)
/// on B in the axes of A, and the opposite on A at the same point; J: of the rotation vector's rate, phi' = J^-1 w. The energy
/// d.K d/2 + phi.K_r phi/2 is that of any turn below half a revolution.
class BushingPart final : public numerics::DaePart {
 public:
  BushingPart(const MotionBushing& bushing, MovingFrame first, MovingFrame second);

  void declare(numerics::DaeLayout& /*layout*/) override {}
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override { pattern_ = &pattern; }
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  /// What it does at a state; forces and moments in the axes of the world.
  struct State {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();  ///< d [m], phi [rad]
    multibody::Wrench on_second;                                                      ///< about B's origin
    multibody::Wrench on_first;                                                       ///< about A's origin
    double energy = 0.0;                                                              ///< [J]
    double lost_power = 0.0;                                                          ///< [W], >= 0
  };
  [[nodiscard]] State state(const numerics::VectorView& y) const;
  [[nodiscard]] const MovingFrame& frame(std::size_t k) const { return frames_[k]; }

 private:
  MotionBushing bushing_;
  std::array<MovingFrame, 2> frames_;  // A, B
  const numerics::SparseMatrix* pattern_ = nullptr;
};

}  // namespace snare::coupling
