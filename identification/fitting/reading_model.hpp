#pragma once

namespace snare::identification {

/// How the machine's record differs from what the wire feels.
struct ReadingModel {
  double displacement_offset = 0.0;  ///< recorded displacement at which the pusher touches the wire [m]
  double force_offset = 0.0;         ///< recorded force without contact [N]
  double force_gain = 1.0;           ///< recorded over true force [-], > 0
  /// Of a Kelvin-Voigt wire, N = EA (e + tau de/dt) and so in bending, to first order in tau [s], >= 0; acts
  /// where the record has times.                                                    theory.md (W.14), (I.2)
  double relaxation_time = 0.0;
};

}  // namespace snare::identification
