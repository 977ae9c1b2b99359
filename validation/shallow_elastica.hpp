#pragma once

namespace snare::validation {

/// The clamped-clamped inextensible wire in the limit of small slack, pushed at one point.
///
///   w'''' + P w'' = f delta(x - s),  w = w' = 0 at 0 and 1,  1/2 int w'^2 dx = 1
///
/// in units of the span L, with delta = end shortening over L: w in L sqrt(delta), f = F L^2/(EI
/// sqrt(delta)), P = compression L^2/EI (negative: tension), a = w(s), s the load's position over the span.
///
/// With G(P) the deflection at the load for f = 1, int w'^2 = f^2 dG/dP (the compliance's derivative with
/// respect to the geometric stiffness), hence f = +-sqrt(2/G'), a = f G: closed form, no quadrature. All is
/// dimensionless.
struct ShallowState {
  double compression = 0.0;  ///< P [-]
  double force = 0.0;        ///< f [-], positive when it pushes with the bulge
  double deflection = 0.0;   ///< a [-], positive on the bulge's side
};

/// The state at a given compression, on the bulge's side: f > 0 for P < 4 pi^2, f < 0 above.
/// compression: P, below 80.7629 unless position = 1/2 (the symmetric path beyond its bifurcation);
/// position: s in (0, 1).  At P = 4 pi^2 exactly: the unloaded wire, f = 0. [-]
[[nodiscard]] ShallowState shallow_state(double compression, double position);

/// The state at a given deflection, pushed with the bulge: P <= 4 pi^2.
/// deflection: in [shallow_natural_deflection, shallow_taut_deflection). Both [-].
[[nodiscard]] ShallowState shallow_state_at(double deflection, double position);

/// Unloaded: a = (1 - cos 2 pi s)/pi [-].
[[nodiscard]] double shallow_natural_deflection(double position);

/// Two straight halves: a = sqrt(2 s (1 - s)) [-], the limit P -> -infinity.
[[nodiscard]] double shallow_taut_deflection(double position);

/// Pushed against the bulge, the largest force under load control: the maximum of -f on 4 pi^2 < P <=
/// 80.7629. At position 1/2 it is the bifurcation of the symmetric path. [-]
[[nodiscard]] ShallowState shallow_largest_inward(double position);

/// F L^3/(EI d) [-] of the antisymmetric-mode branch at mid-span, 207.744: there P stays at 80.7629.
[[nodiscard]] double shallow_branch_stiffness();

}  // namespace snare::validation
