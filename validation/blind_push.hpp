#pragma once

#include "validation/blind_wire.hpp"

#include <vector>

namespace snare::validation {

/// What the rig would show.
struct BlindReading {
  double force = 0.0;               ///< by the pusher on the wire along the pusher's motion [N]
  double tension_left = 0.0;        ///< N = n . t at the left mount [N]
  double tension_right = 0.0;       ///< at the right one [N]
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
/// bending in the wire next to the mount lowers the energy when wire is fed. A mount that slides moves along
/// x with the wire, |n_x| <= T_s; the right mount is the left one of the mirrored wire.
/// Pusher: r(S_c) = a + R nu(S_c), a = touch + (travel - c_p F) m, f = n(S_c-) - n(S_c+), F = f . m. Sliding:
/// f . t = sgn mu f . nu with sgn the sign of d(S_c + R th_c); sticking: d(S_c + R th_c) = 0. It sticks at
/// first touch.
/// Strands: M grows by EI_x (kappa - kappa_p), bounded by EI_x kappa_slip, or in layers by a sum of such.
/// Yield: a share h = 0.02 of EA and of EI stays elastic, the rest is elastic and perfectly plastic, in
/// bending in 20 fibres of the round section, without interaction of bending and tension. Both start unloaded
/// in the straight wire. Viscous: e and kappa are replaced by e + tau de/dt and kappa + tau dkappa/dt at
/// fixed S, by implicit Euler from rest at time 0.
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
