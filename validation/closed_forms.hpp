#pragma once

namespace snare::validation {

/// Transverse stiffness F/w at the load of a wire clamped at both ends, under tension [N/m].
///   w'''' - (T/EI) w'' = (F/EI) delta(x - s)
/// Limits: T -> 0 gives 3 EI l^3/(s^3 (l-s)^3), EI -> 0 gives T l/(s (l-s)).
/// bending_stiffness: EI [N m^2], > 0; tension: T [N], any above the buckling load; span: l [m], > 0;
/// position: s [m], in (0, l). Small deflection against the span.
[[nodiscard]] double tensioned_clamped_stiffness(double bending_stiffness, double tension, double span,
                                                 double position);

/// Force that deflects a taut string by d:  F = T d l/(s (l-s))  [N].  Tension unchanged by d.
[[nodiscard]] double string_force(double tension, double span, double position, double deflection);

/// Force that deflects a straight wire without bending stiffness, unstressed at d = 0, slack-free:
///   F = EA d^3/(2 l) (1/s + 1/(l-s))^2  [N],
/// from the elongation d^2/2 (1/s + 1/(l-s)), tension EA/l times it. Leading order in d/s; the load slides
/// freely, so the tension is the same on both sides. axial_stiffness: EA [N].
[[nodiscard]] double unstretched_wire_force(double axial_stiffness, double span, double position,
                                            double deflection);

/// Three-point bending of a beam on two supports, load at s:  F/d = 3 EI l/(s^2 (l-s)^2)  [N/m].
[[nodiscard]] double three_point_stiffness(double bending_stiffness, double span, double position);

/// How a column's ends are held.
enum class ColumnEnds { clamped_free, pinned_pinned, clamped_pinned, clamped_clamped };

/// Euler's buckling load: c EI/l^2 [N], c = pi^2/4, pi^2, 20.1907 (tan x = x, x^2), 4 pi^2.
/// Timoshenko and Gere 1961, sec. 2.1-2.3.
[[nodiscard]] double buckling_load(ColumnEnds ends, double bending_stiffness, double length);

/// Second buckling load of a clamped-clamped column, antisymmetric: 4 x^2 EI/l^2 [N] with tan x = x, 80.7629.
[[nodiscard]] double second_clamped_buckling_load(double bending_stiffness, double length);

/// Smallest positive root of tan x = x, 4.493409 [rad].
[[nodiscard]] double first_root_of_tan_x_equals_x();

/// Ratio of the tensions of a flexible line slipping over a fixed pin: exp(mu phi) [-].
/// friction: mu >= 0 [-]; wrap_angle: phi >= 0 [rad].  Euler 1762, Eytelwein 1808.
[[nodiscard]] double capstan_ratio(double friction, double wrap_angle);

}  // namespace snare::validation
