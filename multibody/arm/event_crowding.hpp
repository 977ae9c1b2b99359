#pragma once

#include "numerics/dae.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace snare::multibody {

/// Notices events that crowd: between torques that point at a jump of its law from both sides a joint ends
/// its motion at the jump, which no sequence of modes describes. A swing passes a jump some tens of times a
/// second at most.
class EventCrowding {
 public:
  explicit EventCrowding(int joints) : times_(static_cast<std::size_t>(joints)) {}

  /// Told an event of a joint [s]; true: more than a hundred within a tenth of a second.
  [[nodiscard]] bool crowded(int joint, double time) {
    constexpr double window = 0.1;  // [s]
    std::vector<double>& times = times_[static_cast<std::size_t>(joint)];
    times.push_back(time);
    if (times.size() <= too_many) return false;
    const double before = times.front();
    times.erase(times.begin());
    return time - before < window;
  }

  /// Appends what it knows to a memory, and takes it back: see numerics::DaePart. Times [s].
  void save_state(std::vector<double>& memory) const {
    for (const std::vector<double>& times : times_) {
      memory.push_back(static_cast<double>(times.size()));
      memory.insert(memory.end(), times.begin(), times.end());
    }
  }
  void restore_state(std::span<const double>& memory) {
    for (std::vector<double>& times : times_) {
      times.resize(std::min(static_cast<std::size_t>(numerics::take(memory)), too_many));
      for (double& time : times) time = numerics::take(memory);
    }
  }

 private:
  static constexpr std::size_t too_many = 100;
  std::vector<std::vector<double>> times_;  // the last of each joint [s], at most too_many
};

}  // namespace snare::multibody
