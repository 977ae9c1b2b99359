#pragma once

namespace snare::coupling {

/// Transverse stiffness of a wire clamped at both ends, under tension, at its loaded point, and its
/// derivative.
///   k = EI m^3 D/N,  m = sqrt(T/EI),  a = m s,  b = m (l - s),  c = m l                      theory.md (R.6)
///   D = 2 (1 - cosh c) + c sinh c
///   N = 2 (sinh c - sinh a - sinh b) + 2 a cosh a + 2 b cosh b - c (cosh c + cosh a cosh b) + a b sinh c
/// from w'''' - m^2 w'' = P/EI delta(x - s). T -> 0: 3 EI l^3/(a^3 b^3) with lengths; EI -> 0: T l/(s (l -
/// s)).
/// bending_stiffness: EI [N m^2], > 0; tension: any above the buckling load -4 pi^2 EI/l^2 [N]; span: l [m],
/// > 0;
/// position: s in (0, l) [m].
struct TensionedStiffness {
  double value = 0.0;       ///< [N/m]
  double by_tension = 0.0;  ///< [1/m]
};
[[nodiscard]] TensionedStiffness tensioned_stiffness(double bending_stiffness, double tension, double span,
                                                     double position);

}  // namespace snare::coupling
