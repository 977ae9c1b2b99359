#pragma once

#include <limits>

namespace snare::coupling {

/// Whether the tension of a wire is followed from step to step, and when it counts as tight.
struct WireTightness {
  bool watched = false;
  double tension =
      std::numeric_limits<double>::infinity();  ///< least tension [N], > 0; infinite: never tight
  double hold = 0.05;                           ///< for so long without a break [s], >= 0
};

/// What the ends of a wire have felt: see end_tension.
struct WireUse {
  static constexpr double never = std::numeric_limits<double>::infinity();
  double peak_tension = 0.0;   ///< [N], at accepted steps
  double peak_time = 0.0;      ///< [s]
  double tight_since = never;  ///< tight from then on, until now [s]
  /// When it was tight for the first time for as long as asked: the beginning of that [s].
  double tight_at = never;
  double last_tension = 0.0, last_time = 0.0;  // [N], [s]

  /// At an accepted step, time [s] and tension [N]: straight between two steps.
  void add(const WireTightness& asked, double time, double tension) {
    if (tension > peak_tension) {
      peak_tension = tension;
      peak_time = time;
    }
    if (tension < asked.tension) {
      tight_since = never;
    } else if (tight_since == never) {
      const double rise = tension - last_tension;
      const double share =
          rise > 0.0 && last_tension < asked.tension ? (asked.tension - last_tension) / rise : 1.0;
      tight_since = last_time + share * (time - last_time);
    }
    if (tight_at == never && tight_since != never && time - tight_since >= asked.hold) tight_at = tight_since;
    last_tension = tension;
    last_time = time;
  }
};

}  // namespace snare::coupling
