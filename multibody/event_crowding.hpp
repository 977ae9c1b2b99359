#pragma once

#include <cstddef>
#include <vector>

namespace snare::multibody {

/// Notices events that crowd: between torques that point at a jump of its law from both sides a joint ends its motion at the
/// jump, which no sequence of modes describes. A swing passes a jump some tens of times a second at most.
class EventCrowding {
 public:
  explicit EventCrowding(int joints) : times_(static_cast<std::size_t>(joints)) {}

  /// Told an event of a joint [s]; true: more than a hundred within a tenth of a second.
  [[nodiscard]] bool crowded(int joint, double time) {
    constexpr double window = 0.1;  // [s]
    constexpr std::size_t too_many = 100;
    std::vector<double>& times = times_[static_cast<std::size_t>(joint)];
    times.push_back(time);
    return times.size() > too_many && time - times[times.size() - 1 - too_many] < window;
  }

 private:
  std::vector<std::vector<double>> times_;  // of each joint [s]
};

}  // namespace snare::multibody
