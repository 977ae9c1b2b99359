#pragma once

#include <Eigen/Core>

#include <functional>

namespace snare::coupling {

struct Motion;
struct MotionSample;

/// What a sensor tells while a motion runs: three numbers (or one, then two zeros) of its samples, read at a
/// rate, late and with noise.
///
/// Reading i comes at i times the interval and tells what was there a delay earlier (at the start where that
/// is before it): the sample of the output time there, between two output times straight.    theory.md (M.23)
struct SensedSignal {
  using Sight = std::function<Eigen::Vector3d(const MotionSample& sample)>;
  std::function<Sight(const Motion& motion)> make;  ///< what it sees, in the unit of its readings
  double interval = 0.0;  ///< between two readings, a whole multiple of that of the output [s], > 0
  double delay = 0.0;     ///< [s], >= 0
  std::function<Eigen::Vector3d(long reading)> noise;  ///< added to a reading; empty: none
};

/// A bound of the last reading of a sensed signal.
struct SensedBound {
  int sensed = 0;      ///< index among the sensed signals of the motion
  int component = -1;  ///< 0, 1, 2; -1: of the size of all three
  bool above = true;   ///< must be at least the bound; false: at most
  double bound = 0.0;  ///< in the unit of the readings

  /// Whether a reading, in the unit of the bound, keeps it.
  [[nodiscard]] bool kept_by(const Eigen::Vector3d& reading) const {
    const double value = component < 0 ? reading.norm() : reading[component];
    return above ? value >= bound : value <= bound;
  }
};

}  // namespace snare::coupling
