#pragma once

#include "coupling/contact/revolved_shape.hpp"

#include <memory>

namespace snare::coupling {

/// A finite cylinder with sharp rims about z, centred at the origin; radius, length > 0 [m].
[[nodiscard]] std::shared_ptr<const ContactShape> finite_cylinder(double radius, double length);

/// A truncated cone with sharp rims about z, centred at the origin: radii at z = -length/2 and length/2, >= 0
/// and not both 0 [m]; one of 0 is a full cone.
[[nodiscard]] std::shared_ptr<const ContactShape> truncated_cone(double lower_radius, double upper_radius,
                                                                 double length);

/// A ring about z, centred at the origin, open at both ends: what lies along a housing meets its inside,
/// where the distance is inner_radius less that from the axis. 0 < inner_radius < outer_radius, length > 0,
/// rounding of its four rims >= 0, at most half the length and half the wall [m]. Throws InputError.
[[nodiscard]] std::shared_ptr<const ContactShape> hollow_cylinder(double inner_radius, double outer_radius,
                                                                  double length, double rounding);

/// A cup about z that opens upward: its floor at z = 0, its inner wall from there to the mouth at z = depth.
struct Cup {
  double inner_radius = 0.0;  ///< [m], > 0
  double depth = 0.0;         ///< [m], > 0
  double thickness = 0.0;     ///< of wall and floor [m], > 0
  /// Of the rims of the mouth and of the floor's outer one [m], >= 0, at most half the thickness.
  double rounding = 0.0;
  double fillet = 0.0;  ///< of the concave corner between wall and floor [m], >= 0
};
/// Throws InputError.
[[nodiscard]] std::shared_ptr<const ContactShape> cup(const Cup& cup);

/// The shaft of a grapple fixture with its cam-shaped tip: what the closing wires meet. From z = 0, its foot
/// on the target's plate, a cylinder; then a cone (the cam's underside, behind which the wires cannot slip
/// off), an arc that bulges by `bulge`, and a flat end.
///
/// No dimension is published in the sources at hand; the defaults are assumptions: a shaft as thick as the
/// pin of the published static tests is taken to be, a cam of twice its radius.
struct GrappleShaft {
  double shaft_radius = 6e-3;      ///< [m], > 0
  double shaft_length = 60e-3;     ///< up to where the cam begins [m], > 0
  double cam_radius = 12e-3;       ///< largest [m], > shaft_radius
  double underside_length = 6e-3;  ///< height of the cone under the cam's largest radius [m], >= 0
  double cam_length = 18e-3;       ///< from the largest radius to the flat end [m], > 0
  double end_radius = 4e-3;        ///< of the flat end [m], > 0, < cam_radius
  double bulge = 2e-3;             ///< of the arc over its chord [m], >= 0, at most half the chord
};
/// Throw InputError.
[[nodiscard]] Profile grapple_profile(const GrappleShaft& shaft);
[[nodiscard]] std::shared_ptr<const ContactShape> grapple_shaft(const GrappleShaft& shaft);

}  // namespace snare::coupling
