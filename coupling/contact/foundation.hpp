#pragma once

#include <Eigen/Core>

namespace snare::coupling {

/// The elastic foundation between a wire and what it touches: a pressure along the wire.      theory.md (M.8)
///
///   p = k d (1 + a d'),  never negative;   d = -g penetration, d' its rate by motion across the wire
/// A wire that crosses a rounded edge, with the curvature c of the gap along it, then meets the force
/// F = 4/3 k sqrt(2/c) d^(3/2) of its deepest point, as Hertz's law is; one that lies along a surface the line load k d.
/// Two steel cylinders give about pi E/(8 (1 - nu^2)) = 8e10 N/m^2. The default is stiffer, so that what the wire
/// sinks in does not count beside what it stretches: a solid steel wire of 1.5 mm 0.3 um at 100 N on a pin of 6 mm.
struct ElasticFoundation {
  double modulus = 0.0;  ///< k: load per length and penetration [N/m^2], >= 0; 0: see default_modulus
  /// a: share of the load by the speed of approach [s/m], >= 0 (Hunt and Crossley 1975). With the default what is struck at
  /// some millimetres a second does not bounce: the wire's own elasticity returns a body.
  double damping = 1000.0;

  /// Load per length [N/m] and its derivatives by gap and gap rate.
  [[nodiscard]] Eigen::Vector3d load(double gap, double gap_rate) const {
    const double rate = 1.0 - damping * gap_rate;
    if (gap >= 0.0 || rate <= 0.0) return Eigen::Vector3d::Zero();
    return {-modulus * gap * rate, -modulus * rate, modulus * gap * damping};
  }
  /// Of the load the part that is stored and given back [N/m].
  [[nodiscard]] double elastic_load(double gap) const { return gap < 0.0 ? -modulus * gap : 0.0; }
  /// Energy per length [J/m].
  [[nodiscard]] double energy(double gap) const { return gap < 0.0 ? 0.5 * modulus * gap * gap : 0.0; }
};

/// 30 EA/d^2 [N/m^2]: thirty times what the section itself gives. diameter [m]; 0: of a solid round section.
[[nodiscard]] double default_modulus(double axial_stiffness, double bending_stiffness, double diameter);

/// How long a piece of a wire gives way where its mount meets a surface [m]: as long as the surface's radius with the wire's, but at
/// least four diameters. The arguments as with default_modulus; radius: smallest of the convex surface [m], 0 or infinite: none.
///                                                                                          theory.md (M.35)
[[nodiscard]] double mount_length(double axial_stiffness, double bending_stiffness, double diameter, double radius);

}  // namespace snare::coupling
