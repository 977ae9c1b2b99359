#include "coupling/dynamics/force_record.hpp"

#include <cassert>
#include <utility>

namespace snare::coupling {

void ForceRecord::add(double time, Eigen::VectorXd forces) {
  records_.push_back({time, std::move(forces)});
  if (records_.size() > 3) records_.pop_front();
}

// Newton's form: f_1 + [f_1, f_0] (t - t_1) + [f_1, f_0, f_-1] (t - t_1)(t - t_0), the latest being 1.
double ForceRecord::at(double time, Eigen::Index index, bool of_three) const {
  assert(records_.size() >= 2);
  const auto latest = records_.rbegin();
  const auto slope = [&](const Record& a, const Record& b) {
    return (a.forces[index] - b.forces[index]) / (a.time - b.time);
  };
  const Record &last = latest[0], &before = latest[1];
  double force = last.forces[index] + slope(last, before) * (time - last.time);
  if (of_three && records_.size() == 3) {
    const Record& first = latest[2];
    const double curvature = (slope(last, before) - slope(before, first)) / (last.time - first.time);
    force += curvature * (time - last.time) * (time - before.time);
  }
  return force;
}

}  // namespace snare::coupling
