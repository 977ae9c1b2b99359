#pragma once

#include "wire/end.hpp"

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace snare::wire {

/// How a mount holds one end of a spatial rod.
struct SpatialEnd {
  enum class Kind {
    clamp,         ///< position, direction and twist
    twisting_pin,  ///< position and twist, free to turn in any direction (a constant-velocity joint)
    pin,           ///< position (a ball joint)
    free           ///< nothing
  };
  Kind kind = Kind::clamp;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of increasing arc length; unit
  Eigen::Vector3d director = Eigen::Vector3d::UnitY();   ///< d1 of the mount, perpendicular to it; unit
  /// Of the rod's material director m1 from `director`, about `direction` [rad]; any number of turns.
  double twist_angle = 0.0;
  /// Of a clamp that gives in bending, the same about both axes [N m/rad], > 0. In series with the half cell
  /// beside the mount, for kappa_1 and kappa_2 each: the law is linear in 2 tan(phi/2) of the mount's and the
  /// half cell's turn together, so it errs by the third power of the angle by which the mount gives.
  double rotational_stiffness = std::numeric_limits<double>::infinity();
  /// Of a mount that gives in twist [N m/rad], > 0.
  double twisting_stiffness = std::numeric_limits<double>::infinity();
  /// Along x, of a mount that gives [N/m], > 0.
  double translational_stiffness = std::numeric_limits<double>::infinity();

  /// Whether the mount has a direction and a director that the rod feels.
  [[nodiscard]] bool orients() const noexcept { return kind == Kind::clamp || kind == Kind::twisting_pin; }
  /// Whether the mount holds the wire along x by a spring.
  [[nodiscard]] bool gives() const noexcept {
    return kind != Kind::free && !std::isinf(translational_stiffness);
  }
  /// 1/2 k (x - X)^2 of that spring [J].                                                      theory.md (W.6)
  [[nodiscard]] double spring_energy(double x) const noexcept {
    if (!gives()) return 0.0;
    const double give = x - position.x();
    return 0.5 * translational_stiffness * give * give;
  }
};

/// Which strains of a spatial rod store energy.
enum class Strains {
  all,
  twist  ///< alone; somebody else adds bending and stretching
};

/// Constants of a uniform spatial rod.
struct SpatialRodProperties {
  double bending_stiffness = 0.0;         ///< EI_1 of kappa_1, towards director m1 [N m^2], > 0
  double second_bending_stiffness = 0.0;  ///< EI_2 of kappa_2, towards director m2 [N m^2], > 0
  double torsional_stiffness = 0.0;       ///< GJ [N m^2], > 0
  double axial_stiffness = 0.0;           ///< EA [N], > 0
  Eigen::Vector2d natural_curvature = Eigen::Vector2d::Zero();  ///< of kappa_1, kappa_2 [1/m]
  double natural_twist = 0.0;                                   ///< [rad/m]
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();             ///< force per unstretched length [N/m]
  SpatialEnd left;
  SpatialEnd right;
  [[nodiscard]] const SpatialEnd& end(End which) const noexcept { return which == End::left ? left : right; }
  [[nodiscard]] SpatialEnd& end(End which) noexcept { return which == End::left ? left : right; }
};

}  // namespace snare::wire
