#pragma once

#include "numerics/cubic_spline.hpp"

#include <memory>
#include <vector>

namespace snare::multibody {

/// How a motor gets from one angle to another.                                               theory.md (A.12)
enum class CourseKind {
  /// r = from + (to - from) (10 s^3 - 15 s^4 + 6 s^5), s = (t - begin)/duration: at rest at both ends
  quintic,
  ramped,  ///< a constant rate, reached and left within `ramp` with a constant acceleration
  table    ///< r = from + the value of `table` at t - begin, from its first knot to its last
};

/// Of a line through values (of any unit) the times [s] at which it leaves a level stretch: an integration
/// that stops there cannot step over what follows.
[[nodiscard]] std::vector<double> ends_of_rest(const std::vector<double>& times,
                                               const std::vector<double>& values);

/// Where a motor is told to be: rate continuous, at rest before and after.
struct Course {
  /// A quintic course from `at` to `end` [rad, m], begun at `start` and lasting `time` [s], or with the
  /// defaults none.
  explicit(false) Course(double at = 0.0, double end = 0.0, double start = 0.0, double time = 0.0)
      : from(at), to(end), begin(start), duration(time) {}

  double from = 0.0, to = 0.0;         ///< [rad], of a slide [m]
  double begin = 0.0, duration = 0.0;  ///< [s], duration >= 0; 0: a step
  CourseKind kind = CourseKind::quintic;
  double ramp = 0.0;  ///< [s], in (0, duration/2]
  /// Values from 0 on, of level ends; `to` and `duration` follow from it.
  std::shared_ptr<const numerics::HermiteCurve> table;
  bool smooth = false;        ///< the table is a C2 spline: nothing jumps at its inner knots
  std::vector<double> stops;  ///< of a smooth table [s from its beginning]

  /// Where the motor is told to be at a time [s]: [rad], of a slide [m]; `from` before the course, `to` after
  /// it.
  [[nodiscard]] double angle(double time) const;
  /// Its derivative by time [rad/s, m/s]; zero before and after.
  [[nodiscard]] double rate(double time) const;
  /// Piecewise continuous [rad/s^2, m/s^2]; at a break the later one. Zero before and after.
  [[nodiscard]] double acceleration(double time) const;
  /// Times [s] up to which the integration must go, not across: where the course begins, ends or changes its
  /// acceleration at once.
  [[nodiscard]] std::vector<double> breaks() const;
  /// The first of them behind a time [s]; infinity where there is none.
  [[nodiscard]] double next_break(double time) const;

  /// Standing at an angle [rad].
  [[nodiscard]] static Course standing(double angle) { return Course(angle, angle); }
  /// From an angle to another [rad] at a rate > 0 [rad/s], begun at a time, with ramps [s]; the ramps are
  /// shorter where the distance needs no more.
  [[nodiscard]] static Course at_rate(double from, double to, double begin, double rate, double ramp);
  /// Through values [rad] at times [s] from 0 on, at least two, strictly ascending; at rest at both ends,
  /// without overshoot between.
  [[nodiscard]] static Course through(double from, double begin, const std::vector<double>& times,
                                      const std::vector<double>& values);
  /// The same by the C2 spline: its acceleration has no jumps, as a motor needs whose torque is asked for.
  /// Between the values it may overshoot. Values [rad] at times [s] as of `through`.
  [[nodiscard]] static Course smoothly_through(double from, double begin, const std::vector<double>& times,
                                               const std::vector<double>& values);
};

}  // namespace snare::multibody
