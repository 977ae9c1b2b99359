#pragma once

#include "coupling/dynamics/joints/frame_forces.hpp"
#include "coupling/dynamics/model/bushing.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::coupling {

/// A bushing in a DAE: no unknowns, a wrench on either carrier.                              theory.md (M.22)
///
///   d = R_A^T (p_B - p_A),  phi = log(R_A^T R_B):   F = -(K d + C d'),  M = -(J^-T(phi) K_r phi + C_r w)
/// on B in the axes of A, and the opposite on A at the same point; J: of the rotation vector's rate, phi' =
/// J^-1 w. The energy d.K d/2 + phi.K_r phi/2 is that of any turn below half a revolution.
class BushingPart final : public FrameForces {
 public:
  BushingPart(const MotionBushing& bushing, MovingFrame first, MovingFrame second);

  /// What it does at a state; forces and moments in the axes of the world.
  struct State {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();  ///< d [m], phi [rad]
    multibody::Wrench on_second;                                                      ///< about B's origin
    multibody::Wrench on_first;                                                       ///< about A's origin
    double energy = 0.0;                                                              ///< [J]
    double lost_power = 0.0;                                                          ///< [W], >= 0
  };
  /// At unknowns y of the run (SI units).
  [[nodiscard]] State state(const numerics::VectorView& y) const;
  [[nodiscard]] std::vector<multibody::Wrench> wrenches(const numerics::VectorView& y) const override;
  [[nodiscard]] Work work(const numerics::VectorView& y) const override;

 private:
  [[nodiscard]] Eigen::MatrixXd derivatives(const numerics::VectorView& y) const override;

  MotionBushing bushing_;
};

}  // namespace snare::coupling
