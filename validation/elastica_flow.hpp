#pragma once

#include <array>

namespace snare::validation {

/// Planar extensible Kirchhoff rod, dimensionless: lengths in units of the unstressed length L, forces
/// in EI/L^2, moments in EI/L.  S is the unstressed arc length, t = (cos theta, sin theta).
///
///   r' = (1 + eps N) t,   theta' = kappa0 + M,   M' = -(1 + eps N) V,   n' = 0
///   N = n . t (tension),  V = n . (-sin theta, cos theta) (shear)
///
/// The linear laws are N = EA e and M = EI (theta' - kappa0), both per unit of unstressed length
/// (Reissner 1972 without shear; Magnusson, Ristinmaa and Ljung 2001).  eps = EI/(EA L^2) >= 0 [-];
/// eps = 0 is the inextensible elastica.
struct ElasticaLaw {
  double compliance = 0.0;         ///< eps = EI/(EA L^2) [-], >= 0
  double natural_curvature = 0.0;  ///< kappa0 L [-]
};

/// Cross-section's place and load.  All dimensionless.
struct ElasticaSection {
  double x = 0.0;       ///< along the chord
  double y = 0.0;       ///< towards the bulge
  double angle = 0.0;   ///< of the tangent against the chord [rad]
  double moment = 0.0;  ///< bending moment
};

/// Internal force n = (x, y): what the part at larger S exerts on the part at smaller S.
struct ElasticaForce {
  double x = 0.0;  ///< along the chord [-]
  double y = 0.0;  ///< towards the bulge [-]
};

/// Axial force and shear force of a section.
struct SectionForces {
  double tension = 0.0;  ///< N [-]
  double shear = 0.0;    ///< V [-]
};

/// A force's parts along and across the tangent at this angle [rad].
[[nodiscard]] SectionForces section_forces(ElasticaForce force, double angle);

/// Derivative of the section with respect to S: the right-hand side of the equations above.
[[nodiscard]] ElasticaSection section_rate(const ElasticaLaw& law, const ElasticaSection& section,
                                           ElasticaForce force);

/// The section a piece of rod further on, and how it depends on where it started.
struct ElasticaFlow {
  ElasticaSection end;
  ElasticaSection rate;  ///< d end / d length of the piece
  /// d end / d (angle, moment, n.x, n.y) of the start, rows x, y, angle, moment. The derivative with
  /// respect to the start's x and y is the identity on x and y.
  std::array<std::array<double, 4>, 4> sensitivity{};
};

/// Integrates over one piece of unstressed length `length` [L], any sign, by the Gragg-Bulirsch-Stoer
/// extrapolation method (Hairer, Norsett and Wanner 1993, II.9), together with the variational
/// equations.  A piece that does not reach a relative 1e-14 is halved.
[[nodiscard]] ElasticaFlow elastica_flow(const ElasticaLaw& law, const ElasticaSection& start,
                                         ElasticaForce force, double length);

}  // namespace snare::validation
