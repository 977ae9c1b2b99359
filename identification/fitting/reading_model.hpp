#pragma once

namespace snare::identification {

/// How the machine's record differs from what the wire feels. d, F: recorded travel and force at the time t;
///   true travel  play[d(t - lag)] - d0 - 4 b_d d (1 - d / d_largest)
///   sensed       S = C[F + tau v G],  C[f] = f + c (f smoothed over the creep time)
///   recorded     F0 + drift t + gain (S + 4 b_F S (1 - S / F_largest))
/// v is the speed of the pusher and G the viscous stiffness.                               theory.md (I.2)
struct ReadingModel {
  double displacement_offset = 0.0;  ///< d0, recorded displacement at which the pusher touches the wire [m]
  double force_offset = 0.0;         ///< F0, recorded force without contact [N]
  double force_gain = 1.0;           ///< recorded over true force [-], > 0
  /// Of a Kelvin-Voigt wire, N = EA (e + tau de/dt) and so in bending, to first order in tau [s], >= 0; acts
  /// where the record has times.                                                    theory.md (W.14), (I.2)
  double relaxation_time = 0.0;
  /// b_d, recorded less true travel at half of the largest one, as a share of that [-].
  double travel_bow = 0.0;
  double force_bow =
      0.0;             ///< b_F, recorded less true force at half of the largest one, as a share of that [-]
  double lag = 0.0;    ///< by which the record of the force is behind that of the travel [s]
  double play = 0.0;   ///< of the pusher: travel that is lost where it turns back [m]
  double creep = 0.0;  ///< c, share of the force by which the reading creeps under load [-]
  double creep_time = 30.0;  ///< within which it does [s], > 0
  double drift = 0.0;        ///< of the recorded force [N/s], from the beginning of a series
};

/// Whether the record depends on the times of the readings beyond their order.
[[nodiscard]] inline bool needs_times(const ReadingModel& reading) {
  return reading.relaxation_time != 0.0 || reading.lag != 0.0 || reading.creep != 0.0 || reading.drift != 0.0;
}

}  // namespace snare::identification
