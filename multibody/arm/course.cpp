#include "multibody/arm/course.hpp"

#include <algorithm>
#include <cmath>

namespace snare::multibody {

namespace {

/// Way, rate and acceleration of a course of duration 1 per unit of its way.
struct Share {
  double way, rate, acceleration;
};

Share quintic(double s) {
  const double rest = 1.0 - s;
  return {s * s * s * (10.0 + s * (-15.0 + 6.0 * s)), 30.0 * s * s * rest * rest, 60.0 * s * rest * (rest - s)};
}

// Rate u in the middle, u s/r on the ramps: the area of the trapezoid is u (1 - r) = 1.
Share ramped(double s, double ramp) {
  const double rate = 1.0 / (1.0 - ramp);
  if (s < ramp) return {0.5 * rate * s * s / ramp, rate * s / ramp, rate / ramp};
  const double rest = 1.0 - s;
  if (rest <= ramp) return {1.0 - 0.5 * rate * rest * rest / ramp, rate * rest / ramp, -rate / ramp};
  return {rate * (s - 0.5 * ramp), rate, 0.0};
}

Share share_of(const Course& course, double time) {
  const double s = (time - course.begin) / course.duration;
  return course.kind == CourseKind::ramped ? ramped(s, course.ramp / course.duration) : quintic(s);
}

bool runs(const Course& course, double time) {
  return time >= course.begin && time < course.begin + course.duration;
}

}  // namespace

double Course::angle(double time) const {
  if (time < begin) return from;
  if (!runs(*this, time)) return to;
  if (kind == CourseKind::table) return from + table->value(time - begin);
  return from + (to - from) * share_of(*this, time).way;
}

double Course::rate(double time) const {
  if (!runs(*this, time)) return 0.0;
  if (kind == CourseKind::table) return table->slope(time - begin);
  return (to - from) * share_of(*this, time).rate / duration;
}

double Course::acceleration(double time) const {
  if (!runs(*this, time)) return 0.0;
  if (kind == CourseKind::table) return table->curvature(time - begin);
  return (to - from) * share_of(*this, time).acceleration / (duration * duration);
}

std::vector<double> Course::breaks() const {
  std::vector<double> times{begin, begin + duration};
  if (kind == CourseKind::ramped) {
    times.push_back(begin + ramp);
    times.push_back(begin + duration - ramp);
  }
  if (kind == CourseKind::table) {
    for (const double knot : table->knots()) times.push_back(begin + knot);
  }
  return times;
}

Course Course::at_rate(double from, double to, double begin, double rate, double ramp) {
  Course course(from, to, begin);
  course.kind = CourseKind::ramped;
  // Way during both ramps together: rate times ramp.
  const double way = std::abs(to - from);
  course.ramp = std::min(ramp, way / rate);
  course.duration = way / rate + course.ramp;
  return course;
}

Course Course::through(double from, double begin, const std::vector<double>& times, const std::vector<double>& values) {
  std::vector<double> rise(values);
  for (double& value : rise) value -= values.front();
  std::vector<double> held = numerics::monotone_slopes(times, rise, numerics::HermiteCurve(times, rise).slopes());
  held.front() = held.back() = 0.0;
  Course course(from, from + rise.back(), begin, times.back());
  course.kind = CourseKind::table;
  course.table = std::make_shared<const numerics::HermiteCurve>(times, rise, held);
  return course;
}

}  // namespace snare::multibody
