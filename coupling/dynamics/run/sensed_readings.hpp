#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/result.hpp"

#include <Eigen/Core>

#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace snare::coupling {

/// The readings of the sensed signals of a motion, as they come while it runs.               theory.md (M.23)
class SensedReadings {
 public:
  /// Gives the sample at the present time.
  using Sampler = std::function<MotionSample()>;

  /// The motion stays the caller's and outlives it. output_interval [s].
  SensedReadings(const Motion& motion, double output_interval);

  /// Whether nothing is sensed.
  [[nodiscard]] bool empty() const { return signals_.empty(); }
  /// The first time after a time at which something is seen or read, at which the integration must stop [s];
  /// infinite: none.
  [[nodiscard]] double limit(double time) const;
  /// The integration stands at a time [s]: what is seen or read there.
  void cross_break(double time, const Sampler& sample);
  /// The last reading of a signal, in the unit of its kind; there is one from the start on.
  [[nodiscard]] const Eigen::Vector3d& last(int signal) const;

  /// Appends what is seen and not yet read, in SI units.
  void save_state(std::vector<double>& memory) const;
  /// Takes it, in SI units, from the front of `memory`.
  void restore_state(std::span<const double>& memory);

 private:
  struct Signal {
    const SensedSignal* what = nullptr;
    SensedSignal::Sight sight;
    long seen = 0;                         // readings of which all that they tell has been seen
    long read = 0;                         // readings that have come
    std::optional<Eigen::Vector3d> first;  // of reading `seen`, at the earlier of its two output times
    std::deque<Eigen::Vector3d> waiting;   // readings seen that have not come
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
  };
  /// The output time that a reading tells, or the first of two, as a number of intervals, and the share of
  /// the second.
  struct Told {
    long output = 0;
    double share = 0.0;
  };
  [[nodiscard]] Told told(const Signal& signal, long reading) const;
  /// The time at which a signal is next looked at [s].
  [[nodiscard]] double next_look(const Signal& signal) const;

  double output_interval_;
  std::vector<Signal> signals_;
};

}  // namespace snare::coupling
