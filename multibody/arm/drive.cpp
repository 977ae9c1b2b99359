#include "multibody/arm/drive.hpp"

#include <algorithm>
#include <utility>

namespace snare::multibody {

Drive Drive::locked() {
  Drive drive;
  drive.mode = DriveMode::locked;
  return drive;
}

Drive Drive::limp() {
  return {};
}

Drive Drive::on_course(const Course& course) {
  Drive drive;
  drive.mode = DriveMode::course;
  drive.course = course;
  return drive;
}

Drive Drive::holding(double angle, double proportional, double derivative, double limit) {
  Drive drive;
  drive.mode = DriveMode::servo;
  drive.proportional = proportional;
  drive.derivative = derivative;
  drive.limit = limit;
  drive.course.from = drive.course.to = angle;
  return drive;
}

Drive Drive::with_torque(double begin, std::vector<double> times, std::vector<double> values) {
  Drive drive;
  drive.mode = DriveMode::torque;
  drive.begin = begin;
  std::vector<double> stops = ends_of_rest(times, values);
  drive.given = std::make_shared<const Torque>(Torque{std::move(times), std::move(values), std::move(stops)});
  return drive;
}

double Drive::demand(double time, double angle, double rate) const {
  if (mode == DriveMode::servo)
    return proportional * (course.angle(time) - angle) + derivative * (rate_share * course.rate(time) - rate);
  if (mode != DriveMode::torque || time < begin) return 0.0;
  const std::vector<double>& times = given->times;
  const auto after =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time - begin) - times.begin());
  if (after == 0) return given->values.front();
  if (after == times.size()) return given->values.back();
  const double share = (time - begin - times[after - 1]) / (times[after] - times[after - 1]);
  return given->values[after - 1] + share * (given->values[after] - given->values[after - 1]);
}

double Drive::next_break(double time) const {
  if (mode == DriveMode::servo || mode == DriveMode::course) return course.next_break(time);
  if (mode != DriveMode::torque) return std::numeric_limits<double>::infinity();
  if (begin > time) return begin;
  const std::vector<double>& stops = given->stops;
  const auto behind = std::upper_bound(stops.begin(), stops.end(), time - begin);
  return behind == stops.end() ? std::numeric_limits<double>::infinity() : begin + *behind;
}

}  // namespace snare::multibody
