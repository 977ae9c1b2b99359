#pragma once

#include <Eigen/Core>

#include <cmath>

namespace snare::coupling {

/// The elastic foundation between a wire and what it touches: a pressure along the wire.      theory.md (M.8)
///
///   p = k d (1 - a o),  never negative;   d = -g penetration, o the rate of opening: see Opening
/// A wire that crosses a rounded edge, with the curvature c of the gap along it, then meets the force
/// F = 4/3 k sqrt(2/c) d^(3/2) of its deepest point, as Hertz's law is; one that lies along a surface the
/// line load k d. Two steel cylinders give about pi E/(8 (1 - nu^2)) = 8e10 N/m^2. The default is stiffer, so
/// that what the wire sinks in does not count beside what it stretches: a solid steel wire of 1.5 mm 0.3 um
/// at 100 N on a pin of 6 mm.
struct ElasticFoundation {
  double modulus = 0.0;  ///< k: load per length and penetration [N/m^2], >= 0; 0: see default_modulus
  /// a: share of the load by the speed of approach [s/m], >= 0 (Hunt and Crossley 1975). With the default
  /// what is struck at some millimetres a second does not bounce: the wire's own elasticity returns a body.
  double damping = 1000.0;

  /// Load per length [N/m] and its derivatives by gap [m] and opening [m/s].
  [[nodiscard]] Eigen::Vector3d load(double gap, double opening) const {
    const double rate = 1.0 - damping * opening;
    if (gap >= 0.0 || rate <= 0.0) return Eigen::Vector3d::Zero();
    return {-modulus * gap * rate, -modulus * rate, modulus * gap * damping};
  }
  /// The part of the load that is stored and given back [N/m], and its first and second derivatives by the
  /// gap.
  [[nodiscard]] Eigen::Vector3d elastic_load(double gap) const {
    return gap < 0.0 ? Eigen::Vector3d(-modulus * gap, -modulus, 0.0) : Eigen::Vector3d::Zero();
  }
  /// Energy per length [J/m].
  [[nodiscard]] double energy(double gap) const { return gap < 0.0 ? 0.5 * modulus * gap * gap : 0.0; }
};

/// The rate that the damper of a foundation answers [m/s], and its derivatives by the two rates from which it
/// comes.
struct Opening {
  double rate = 0.0;
  double by_gap = 0.0, by_across = 0.0;  ///< [-]

  /// By the rate of the gap alone [m/s].
  [[nodiscard]] static Opening of_gap(double gap_rate) { return {gap_rate, 1.0, 0.0}; }
  /// By the rate of the gap g' and the rate o of the motion across the wire, both [m/s]: a mean of both that
  /// vanishes with either.
  ///   2 g'^2 o^2/(|g'|^3 + |o|^3), with their sign; none where the signs differ
  /// Its derivative is continuous, and (p - k d) g' <= 0 always: the damper takes energy, whichever way the
  /// wire moves.
  ///                                                                                          theory.md (M.8)
  [[nodiscard]] static Opening between(double gap_rate, double across) {
    if (!(gap_rate * across > 0.0)) return {};
    const bool gap_is_less = std::abs(gap_rate) < std::abs(across);
    const double less = gap_is_less ? gap_rate : across, more = gap_is_less ? across : gap_rate,
                 x = less / more;
    const double cube = x * x * x, sum = 1.0 + cube;
    const double by_less = 2.0 * x * (2.0 - cube) / (sum * sum),
                 by_more = 2.0 * x * x * (2.0 * cube - 1.0) / (sum * sum);
    return {2.0 * x * x / sum * more, gap_is_less ? by_less : by_more, gap_is_less ? by_more : by_less};
  }
};

/// 30 EA/d^2 [N/m^2]: thirty times what the section itself gives. diameter [m]; 0: of a solid round section.
[[nodiscard]] double default_modulus(double axial_stiffness, double bending_stiffness, double diameter);

/// How long a piece of a wire gives way where its mount meets a surface [m]: as long as the surface's radius
/// with the wire's, but at least four diameters. The arguments as with default_modulus; radius: smallest of
/// the convex surface [m], 0 or infinite: none.
///                                                                                           theory.md (M.35)
[[nodiscard]] double mount_length(double axial_stiffness, double bending_stiffness, double diameter,
                                  double radius);

}  // namespace snare::coupling
