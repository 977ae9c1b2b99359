#pragma once

#include <vector>

namespace snare::scenario {

/// One swing of a joint's deflection from zero to zero. In rad, of a joint that slides in m.
struct Swing {
  double begin = 0.0, end = 0.0;  ///< zeros of the deflection [s]
  double peak = 0.0;              ///< largest deflection between them, with its sign [rad]
  /// Of the vibration of which this is one half [Hz].
  [[nodiscard]] double frequency() const { return 0.5 / (end - begin); }
};

/// A joint at a time.
struct SwingSample {
  double time = 0.0;        ///< [s]
  double deflection = 0.0;  ///< [rad]
  double rate = 0.0;        ///< of it [rad/s]
};

/// The swings, by Hermite's cubics between the samples; what comes before the first zero is none.
[[nodiscard]] std::vector<Swing> swings(const std::vector<SwingSample>& samples);

}  // namespace snare::scenario
