#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

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
  double mount_slip_tension = std::numeric_limits<double>::infinity();  ///< T_s of the left mount [N], > 0

  double misalignment = 0.0;       ///< of the pusher's motion a [rad]: along (sin a, cos a)
  double pusher_compliance = 0.0;  ///< along the motion [m/N], >= 0
  double friction = 0.0;           ///< Coulomb's coefficient between pusher and wire [-], >= 0

  double strand_extra_stiffness = 0.0;  ///< EI_x while the strands hold together [N m^2], >= 0
  double strand_slip_curvature = 0.0;   ///< at which they slip [1/m], >= 0

  double yield_stress = std::numeric_limits<double>::infinity();  ///< sigma_y [Pa], > 0
  double relaxation_time = 0.0;                                   ///< tau of Kelvin and Voigt [s], >= 0

  int intervals = 120;         ///< collocation intervals on either side of the contact, >= 8
  int history_points = 1200;   ///< material points that carry a memory, >= 2
  double history_step = 1e-4;  ///< largest travel between two updates of a memory [m], > 0
  int viscous_steps = 4;       ///< least number of time steps between two readings, >= 1
};

/// What the rig would show.
struct BlindReading {
  double force = 0.0;               ///< by the pusher on the wire along the pusher's motion [N]
  double tension_left = 0.0;        ///< N = n . t at the left mount [N]
  double contact_coordinate = 0.0;  ///< unstressed coordinate of the touched section S_c [m]
};

/// The force-displacement curve of the planar extensible elastica under a point contact, quasi-static, solved
/// by collocation; it shares nothing with the discrete rod.
///
/// On S in [S_0, L], with t = (cos th, sin th), nu = (-sin th, cos th) and N = n . t:
///   r' = (1 + e) t,  th' = kappa,  n' = -w,  M' = -(1 + e) n . nu                  (S' = d/dS)
///   N = EA e,  M = EI (kappa + kappa_nat)                                          (elastic)
///   x(S_0) = c n_x,  x(L) = span - c n_x,  th(S_0) = c_r M,  th(L) = -c_r M        (mounts that give)
/// Mount slip: C = N + N^2/(2 EA) + M^2/(2 EI) at S_0; |C| < T_s holds S_0, C = T_s draws wire in (S_0
/// falls), C = -T_s pushes it out. The bending term has the sign of the sliding sleeve (Bigoni et al. 2015):
/// bending in the wire next to the mount lowers the energy when wire is fed.
/// Pusher: r(S_c) = a + R nu(S_c), a = touch + (travel - c_p F) m, f = n(S_c-) - n(S_c+), F = f . m. Sliding:
/// f . t = sgn mu f . nu with sgn the sign of d(S_c + R th_c); sticking: d(S_c + R th_c) = 0. It sticks at
/// first touch.
/// Strands: M grows by EI_x (kappa - kappa_p), bounded by EI_x kappa_slip. Yield: a share h = 0.02 of EA and
/// of EI stays elastic, the rest is elastic and perfectly plastic, in bending in 20 fibres of the round
/// section, without interaction of bending and tension. Both start unloaded in the straight wire. Viscous: e
/// and kappa are replaced by e + tau de/dt and kappa + tau dkappa/dt at fixed S, by implicit Euler from rest
/// at time 0.
///
/// travel: of the pusher after first touch [m], in the order of the test. time: empty, or one for each
/// reading, from first touch, increasing [s]; needed when relaxation_time > 0. A lost contact reads force 0.
/// Relative error of the force at the default mesh: below 1e-6 for elastic wires; with a memory
/// about 4e-4 of the peak for strands and 1e-3 for yield, and of the first order in the time step, 3e-3 at
/// tau = 5 times the readings' spacing in time.
/// Throws std::invalid_argument for a value outside its range, std::runtime_error naming the travel where the
/// path cannot be followed or the wire would be bent sharper than the pusher.
[[nodiscard]] std::vector<BlindReading> blind_push(const BlindWire& wire, const std::vector<double>& travel,
                                                   const std::vector<double>& time = {});

}  // namespace snare::validation
