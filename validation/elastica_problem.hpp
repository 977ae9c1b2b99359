#pragma once

namespace snare::validation {

/// A wire as the elastica sees it. SI units.
struct ElasticaWire {
  double length = 0.0;             ///< unstressed length L [m], > 0
  double bending_stiffness = 0.0;  ///< EI [N m^2], > 0
  double axial_stiffness = 0.0;    ///< EA [N], > 0; infinity makes the wire inextensible
  double natural_curvature = 0.0;  ///< uniform, positive turns the tangent counter-clockwise [1/m]
};

/// How both mounts hold the wire.
enum class ElasticaEnds {
  clamped,  ///< position held, tangent along the chord
  pinned    ///< position held, no moment
};

/// What the pusher does to the wire where it touches.
enum class ElasticaContact {
  sliding,        ///< force on the wire's normal, or inclined to it by atan(friction_slope)
  sticking,       ///< the material point of the first touch stays at the pusher's tip; radius 0 only
  material_point  ///< a force along y at a given material point, which is free along the chord
};

/// From which side the pusher comes.
enum class ElasticaSide {
  with_bulge,    ///< pusher below the wire, moves towards +y
  against_bulge  ///< pusher above the wire, moves towards -y
};

/// The wire between two mounts on a chord of length `span` along +x from (0, 0), bulging towards +y,
/// and a knife edge or a cylinder that is moved along y.
struct ElasticaPush {
  ElasticaWire wire;
  double span = 0.0;  ///< distance of the mounts l [m], > 0; a span >= L gives a straight, taut wire
  ElasticaEnds ends = ElasticaEnds::clamped;
  double mount_axial_compliance = 0.0;       ///< of each mount along the chord [m/N], >= 0
  double mount_rotational_compliance = 0.0;  ///< of each clamp [rad/(N m)], >= 0
  ElasticaContact contact = ElasticaContact::sliding;
  ElasticaSide side = ElasticaSide::with_bulge;
  double position = 0.0;  ///< of the pusher's axis along the chord, s [m], in (0, l); not for material_point
  double radius = 0.0;    ///< from the pusher's axis to the wire's axis [m], >= 0; 0 is a knife edge
  /// Tangential over normal force on the wire, in [-mu, mu] [-]; positive drags the wire towards +x.
  /// Of a point contact only: the wrapped contact is frictionless. The wire's axis carries the force.
  double friction_slope = 0.0;
  double material_coordinate = 0.0;  ///< material_point only: unstressed arc length S [m], in (0, L)
  int pieces_per_side = 16;          ///< multiple-shooting pieces on either side of the contact, >= 2
};

}  // namespace snare::validation
