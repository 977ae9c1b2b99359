#include "multibody/arm/course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::multibody {

namespace {

/// Way, rate and acceleration of a course of duration 1 per unit of its way.
struct Share {
  double way, rate, acceleration;
};

Share quintic(double s) {
  const double rest = 1.0 - s;
  return {s * s * s * (10.0 + s * (-15.0 + 6.0 * s)), 30.0 * s * s * rest * rest,
          60.0 * s * rest * (rest - s)};
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

std::vector<double> ends_of_rest(const std::vector<double>& times, const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double level = 1e-9 * (*high - *low);
  std::vector<double> ends;
  for (std::size_t k = 1; k + 1 < values.size(); ++k)
    if (std::abs(values[k] - values[k - 1]) <= level && std::abs(values[k + 1] - values[k]) > level)
      ends.push_back(times[k]);
  return ends;
}

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
    for (const double knot : smooth ? stops : table->knots()) times.push_back(begin + knot);
  }
  return times;
}

double Course::next_break(double time) const {
  double next = std::numeric_limits<double>::infinity();
  const auto consider = [&](double t) {
    if (t > time && t < next) next = t;
  };
  if (kind != CourseKind::table) {
    for (const double t : breaks()) consider(t);
    return next;
  }
  consider(begin);
  consider(begin + duration);
  const std::vector<double>& knots = smooth ? stops : table->knots();
  const auto behind =
      std::partition_point(knots.begin(), knots.end(), [&](double k) { return begin + k <= time; });
  if (behind != knots.end()) consider(begin + *behind);
  return next;
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

namespace {

std::vector<double> less_the_first(std::vector<double> values) {
  const double first = values.front();
  for (double& value : values) value -= first;
  return values;
}

/// Through values that begin at zero, at rest at both ends.
Course table_course(double from, double begin, const std::vector<double>& times,
                    const std::vector<double>& rise, std::vector<double> slopes) {
  slopes.front() = slopes.back() = 0.0;
  Course course(from, from + rise.back(), begin, times.back());
  course.kind = CourseKind::table;
  course.table = std::make_shared<const numerics::HermiteCurve>(times, rise, std::move(slopes));
  return course;
}

}  // namespace

Course Course::through(double from, double begin, const std::vector<double>& times,
                       const std::vector<double>& values) {
  const std::vector<double> rise = less_the_first(values);
  return table_course(from, begin, times, rise,
                      numerics::monotone_slopes(times, rise, numerics::HermiteCurve(times, rise).slopes()));
}

Course Course::smoothly_through(double from, double begin, const std::vector<double>& times,
                                const std::vector<double>& values) {
  const std::vector<double> rise = less_the_first(values);
  Course course = table_course(from, begin, times, rise, numerics::HermiteCurve(times, rise).slopes());
  course.smooth = true;
  course.stops = ends_of_rest(times, rise);
  return course;
}

}  // namespace snare::multibody
