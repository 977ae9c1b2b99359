#pragma once

namespace snare::validation {

/// First post-buckled shape of the planar inextensible elastica, by complete elliptic integrals.
///
/// With modulus k and w = sqrt(P/EI):  span/L = 2 E(k)/K(k) - 1,  height = k L/K(k), and
///   clamped-clamped  P = (4 K(k))^2 EI/L^2,   pinned-pinned  P = (2 K(k))^2 EI/L^2.
/// Euler 1744; Love 1927, sec. 263; Bigoni 2012, sec. 1.13.
struct BuckledElastica {
  double modulus = 0.0;       ///< k [-], in (0, 1); sine of half the largest slope
  double compression = 0.0;   ///< P along the chord [N]
  double height = 0.0;        ///< of the crown over the chord [m]
  double crown_moment = 0.0;  ///< magnitude, EI times the curvature there [N m]
};

/// bending_stiffness: EI [N m^2], > 0; length: L [m], > 0; span: in (0, L) [m]. The modulus' relative error
/// is about 1e-16 over the slack (L - span)/L.
[[nodiscard]] BuckledElastica clamped_elastica(double bending_stiffness, double length, double span);
[[nodiscard]] BuckledElastica pinned_elastica(double bending_stiffness, double length, double span);

/// Large deflection of an inextensible cantilever under a dead transverse load at the tip.
///
/// With alpha = F L^2/EI, k^2 = (1 + sin theta)/2, sin phi = 1/(k sqrt 2):
///   K(k) - F(phi, k) = sqrt(alpha),
///   deflection/L = 1 - 2 (E(k) - E(phi, k))/sqrt(alpha),   reach/L = sqrt(2 sin theta/alpha).
/// Bisshopp and Drucker 1945; tabulated by Mattiasson 1981.
struct CantileverTip {
  double angle = 0.0;       ///< theta of the tip [rad]
  double deflection = 0.0;  ///< along the load [m]
  double shortening = 0.0;  ///< of the projection on the clamp's direction, L - reach [m]
};

/// bending_stiffness: EI [N m^2], > 0; length: L [m], > 0; force: F [N], with alpha in [1e-3, 1e3].
[[nodiscard]] CantileverTip cantilever_tip(double bending_stiffness, double length, double force);

/// Cantilever under a moment at the tip: a circular arc of angle M L/EI. Same fields. moment: M [N m].
[[nodiscard]] CantileverTip cantilever_under_moment(double bending_stiffness, double length, double moment);

}  // namespace snare::validation
