#pragma once

namespace snare::validation {

/// Localised (helical) post-buckling of a long clamped rod that is twisted by R and whose ends are brought
/// together by D: the homoclinic solution of the infinite rod, cut to the length.
///
/// With x = M L/B, y = T L^2/B (van der Heijden and Thompson 2000; van der Heijden, Champneys and Thompson
/// 2002; van der Heijden, Neukirch, Goss and Thompson 2003):
///   D/L = sqrt(16/y (1 - x^2/(4 y))),   R = x B/C + 4 acos(x/(2 sqrt y)).
/// Put cos psi = x/(2 sqrt y):  sqrt y = 4 L sin psi/D,  x = 4 L sin 2psi/D, so that
///   4 (L/D)(B/C) sin 2psi + 4 psi = R  is left for psi: the smallest root is taken.
/// The angle phi between tangent and axis obeys cos phi = 1 - (1 - cos phi_0) sech^2(z), z = (S - L/2)/L
/// sqrt(y - x^2/4), cos phi_0 = x^2/(2 y) - 1. Valid while sech^2 at the ends is negligible.
struct HelicalBuckling {
  double moment = 0.0;          ///< M about the axis [N m]
  double tension = 0.0;         ///< T [N]
  double moment_scaled = 0.0;   ///< x = M L/B [-]
  double tension_scaled = 0.0;  ///< y = T L^2/B [-]
  double largest_angle = 0.0;   ///< phi_0 [rad]
  double length = 0.0;          ///< L [m]

  /// (cos phi - cos phi_0)/(1 - cos phi_0) at arc length S in [0, L] [m]: 1 - sech^2 z, 0 at the middle.
  [[nodiscard]] double envelope(double arc_length) const;
};

/// bending_stiffness: B [N m^2], > 0; torsional_stiffness: C [N m^2], > 0; length: L [m], > 0;
/// shortening: D in (0, L) [m]; end_rotation: R [rad], > 0, small enough for a root below psi = pi/4
/// or slightly beyond; NaN in every field when there is none.
[[nodiscard]] HelicalBuckling helical_buckling(double bending_stiffness, double torsional_stiffness,
                                               double length, double shortening, double end_rotation);

/// Smallest torque that buckles a straight rod with clamped ends under a dead axial load, one end free to
/// move along the axis [N m].
///
///   B w'''' - i M w''' - T w'' = 0 (w = y + i z), w = w' = 0 at both ends, has a solution when
///   sinc a sinc b = sinc(a - b),  a, b = L (M +- sqrt(M^2 - 4 B T))/(4 B).
/// T = 0: tan a = a, M = 8.98682 B/L. M = 0: T = -4 pi^2 B/L^2. L -> infinity: M = 2 sqrt(B T)
/// (Greenhill 1883; Love 1927, sec. 272; Timoshenko and Gere 1961, sec. 2.21).
/// tension: T [N], > -4 pi^2 B/L^2.
[[nodiscard]] double critical_torque_clamped(double bending_stiffness, double tension, double length);

/// The same [N m] with the ends free to turn about transverse axes: M^2 = 4 B T + 4 pi^2 B^2/L^2 (Greenhill
/// 1883).
[[nodiscard]] double critical_torque_pinned(double bending_stiffness, double tension, double length);

/// Total twist at which a naturally straight rod closed to a ring leaves its plane: 2 pi sqrt(3) B/C [rad]
/// (Michell 1889; Zajac 1962).
[[nodiscard]] double critical_ring_twist(double bending_stiffness, double torsional_stiffness);

/// Lateral-torsional buckling of a narrow cantilever under a load at the centroid of its tip:
///   F = 4.0126 sqrt(EI GJ)/L^2, from J_{-1/4}(F L^2/(2 sqrt(EI GJ))) = 0 [N].
/// bending_stiffness: about the weak axis. Timoshenko and Gere 1961, sec. 6.3. Strong axis taken as rigid.
[[nodiscard]] double lateral_buckling_load(double bending_stiffness, double torsional_stiffness,
                                           double length);

/// Lateral-torsional buckling of a simply supported narrow beam in pure bending: pi sqrt(EI GJ)/L [N m].
[[nodiscard]] double lateral_buckling_moment(double bending_stiffness, double torsional_stiffness,
                                             double length);

}  // namespace snare::validation
