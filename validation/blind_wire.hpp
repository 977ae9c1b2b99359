#pragma once

#include <Eigen/Core>

#include <limits>

namespace snare::validation {

/// A loose wire with one or several undeclared effects, and the pusher under it. SI units. The mounts stand
/// at (0, 0) and (span, 0) and hold the tangent along +x; the bulge goes to +y. Every effect's default is
/// "none".
struct BlindWire {
  double length = 0.0;  ///< unstressed length between the mounts L [m], > 0
  double span = 0.0;    ///< distance of the mounts [m], > 0; a span >= L gives a straight, taut wire
  double bending_stiffness = 0.0;  ///< EI [N m^2], > 0
  double axial_stiffness = 0.0;    ///< EA [N], > 0
  double diameter = 0.0;           ///< d [m], > 0 where the wire can yield; not read elsewhere
  double position = 0.0;           ///< of the pusher's axis along the chord at first touch [m], in (0, span)
  double radius = 0.0;  ///< from the pusher's axis to the wire's axis R [m], >= 0; 0 is a knife edge
  Eigen::Vector2d weight = Eigen::Vector2d::Zero();  ///< w per unstressed length [N/m]

  double natural_curvature = 0.0;  ///< kappa_nat [1/m]; positive bends with the bulge, to the right

  double damage_from = 0.0;    ///< unstressed coordinate [m]
  double damage_to = 0.0;      ///< [m]
  double damage_factor = 1.0;  ///< of EI between the two [-], > 0; each edge is a C1 ramp of 1 mm

  double mount_axial_compliance = 0.0;       ///< of each mount along the chord [m/N], >= 0
  double mount_rotational_compliance = 0.0;  ///< of each clamp [rad/(N m)], >= 0
  double mount_slip_tension = std::numeric_limits<double>::infinity();  ///< T_s of a mount [N], > 0
  /// The mount slides along the chord with the wire; else the wire feeds through it.
  bool mount_slides = false;
  bool mount_slips_right = false;  ///< it is the right mount; else the left one

  double misalignment = 0.0;       ///< of the pusher's motion a [rad]: along (sin a, cos a)
  double pusher_compliance = 0.0;  ///< along the motion [m/N], >= 0
  double friction = 0.0;           ///< Coulomb's coefficient between pusher and wire [-], >= 0

  double strand_extra_stiffness = 0.0;  ///< EI_x while the strands hold together [N m^2], >= 0
  double strand_slip_curvature = 0.0;   ///< at which they slip [1/m], >= 0
  double strand_slip_breadth =
      0.0;                 ///< b: in `strand_layers` equal shares, the logarithms evenly over +-b [-], >= 0
  int strand_layers = 40;  ///< where b > 0, >= 1

  double yield_stress = std::numeric_limits<double>::infinity();  ///< sigma_y [Pa], > 0
  double relaxation_time = 0.0;                                   ///< tau of Kelvin and Voigt [s], >= 0

  int intervals = 120;         ///< collocation intervals on either side of the contact, >= 8
  int history_points = 1200;   ///< material points that carry a memory, >= 2
  double history_step = 1e-4;  ///< largest travel between two updates of a memory [m], > 0
  int viscous_steps = 4;       ///< least number of time steps between two readings, >= 1
};

}  // namespace snare::validation
