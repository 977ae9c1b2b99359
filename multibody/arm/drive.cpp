#include "multibody/arm/drive.hpp"

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

double Drive::demand(double time, double angle, double rate) const {
  return mode == DriveMode::servo
             ? proportional * (course.angle(time) - angle) + derivative * (rate_share * course.rate(time) - rate)
             : 0.0;
}

}  // namespace snare::multibody
