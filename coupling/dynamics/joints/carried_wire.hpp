#pragma once

#include "coupling/dynamics/joints/moving_frame.hpp"
#include "wire/motion/rod_part.hpp"

#include <Eigen/Core>

#include <array>

namespace snare::coupling {

/// A wire that starts with the motion of what carries its ends.                              theory.md (M.17)
///
///   v(S) = (1 - s) V_1(X) + s V_2(X),   s = S/L,   V_k(x) = v_k + omega_k x (x - p_k)
/// V_k is the rigid motion of the carrier of end k, zero for a mount in the world. With both ends on one
/// carrier the wire moves rigidly with it. Between two carriers the field meets both ends, stretches the wire
/// evenly, and shifts by whatever rigid motion is superposed on both. A free end follows the other carrier.
struct CarriedWire {
  const wire::RodPart* rod = nullptr;
  int wire = 0;                                ///< its index
  std::array<MovingFrame::State, 2> carriers;  ///< motion of the left and the right mount

  /// Velocity of a vertex [m/s], unknowns y in SI units.
  [[nodiscard]] Eigen::Vector3d velocity(int vertex, const Eigen::VectorXd& y) const;
  /// Rate of the angle of an edge [rad/s]: the spin about its tangent. Unknowns y in SI units.
  [[nodiscard]] double twist_rate(int edge, const Eigen::VectorXd& y) const;
};

}  // namespace snare::coupling
