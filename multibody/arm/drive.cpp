#include "multibody/arm/drive.hpp"

namespace snare::multibody {

double Course::angle(double time) const {
  if (time < begin) return from;
  if (time >= begin + duration) return to;
  const double s = (time - begin) / duration;
  return from + (to - from) * s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
}

double Course::rate(double time) const {
  if (time < begin || time >= begin + duration) return 0.0;
  const double s = (time - begin) / duration, rest = 1.0 - s;
  return (to - from) * 30.0 * s * s * rest * rest / duration;
}

Drive Drive::locked() {
  Drive drive;
  drive.mode = DriveMode::locked;
  return drive;
}

Drive Drive::limp() {
  return {};
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

double Drive::demand(double time, double angle, double rate) const {
  return mode == DriveMode::servo
             ? proportional * (course.angle(time) - angle) + derivative * (course.rate(time) - rate)
             : 0.0;
}

}  // namespace snare::multibody
