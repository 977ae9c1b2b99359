#include "coupling/dynamics/joints/robot_loop.hpp"

#include "coupling/dynamics/model/vector_memory.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace snare::coupling {

using Eigen::Vector3d;

namespace {

/// Times that differ by less are one [s].
constexpr double same_time = 1e-13;

}  // namespace

MotionBody RobotLoop::moved() const {
  MotionBody body = body_;
  body.course_velocity = [this](double time) { return velocity(time); };
  body.course_acceleration = [this](double time) { return acceleration(time); };
  return body;
}

// A force that jumps does so where a step ends: at both of its ends the force is that from within it, so that
// two records of one time have the force before and behind.
void RobotLoop::sense_forces(double from, double to, const Force& force) {
  constexpr int pieces = 4;
  constexpr double within = 1e-6;  // of a piece
  Vector3d impulse = records_.empty() ? Vector3d::Zero() : records_.back().impulse;
  if (!(to > from)) {
    records_.push_back({to, impulse, force(to)});
    return;
  }
  const double h = (to - from) / pieces;
  Vector3d before = force(from + within * h);
  records_.push_back({from, impulse, before});
  for (int k = 1; k <= pieces; ++k) {
    const double time = k == pieces ? to : from + k * h;
    const Vector3d now = force(k == pieces ? to - within * h : time);
    impulse += h / 6.0 * (before + 4.0 * force(time - 0.5 * h) + now);
    records_.push_back({time, impulse, now});
    before = now;
  }
  const double oldest = to - body_.robot->delay;
  while (records_.size() > 2 && records_[1].time < oldest) records_.pop_front();
}

bool RobotLoop::begin_interval(double time, bool anew) {
  bool reached = false;
  while (!breaks_.empty() && breaks_.front() <= time + same_time) {
    breaks_.pop_front();
    reached = true;
  }
  if (anew || reached) breaks_.push_back(time + body_.robot->delay);
  return reached;
}

double RobotLoop::next_break(double time) const {
  const auto next =
      std::find_if(breaks_.begin(), breaks_.end(), [time](double b) { return b > time + same_time; });
  return next == breaks_.end() ? std::numeric_limits<double>::infinity() : *next;
}

RobotLoop::Stretch RobotLoop::stretch(double time) const {
  if (records_.empty() || time <= records_.front().time) return {};
  auto to = std::upper_bound(records_.begin(), records_.end(), time,
                             [](double t, const Record& r) { return t < r.time; });
  if (to == records_.end()) return {&records_.back(), &records_.back(), 0.0};
  const auto from = to - 1;
  return {&*from, &*to, (time - from->time) / (to->time - from->time)};
}

// Hermite's cubic of the impulse, and its derivative.
Vector3d RobotLoop::velocity(double time) const {
  const auto [a, b, s] = stretch(time - body_.robot->delay);
  Vector3d impulse = Vector3d::Zero();
  if (a != nullptr) {
    const double h = b->time - a->time, r = 1.0 - s;
    impulse = a->impulse + s * s * (3.0 - 2.0 * s) * (b->impulse - a->impulse) +
              h * s * r * (r * a->force - s * b->force);
  }
  return body_.start.velocity + impulse / body_.robot->mass;
}

Vector3d RobotLoop::acceleration(double time) const {
  const auto [a, b, s] = stretch(time - body_.robot->delay);
  if (a == nullptr) return Vector3d::Zero();
  const double h = b->time - a->time, r = 1.0 - s;
  Vector3d force = r * (1.0 - 3.0 * s) * a->force + s * (3.0 * s - 2.0) * b->force;
  if (h > 0.0) force += 6.0 * s * r / h * (b->impulse - a->impulse);
  return force / body_.robot->mass;
}

void RobotLoop::save_state(std::vector<double>& memory) const {
  memory.push_back(static_cast<double>(records_.size()));
  for (const Record& r : records_) {
    memory.push_back(r.time);
    put_vector(memory, r.impulse);
    put_vector(memory, r.force);
  }
  memory.push_back(static_cast<double>(breaks_.size()));
  memory.insert(memory.end(), breaks_.begin(), breaks_.end());
}

void RobotLoop::restore_state(std::span<const double>& memory) {
  records_.clear();
  const double records = numerics::take(memory);
  for (double k = 0.0; k < records && !memory.empty(); ++k) {
    Record r;
    r.time = numerics::take(memory);
    r.impulse = take_vector(memory);
    r.force = take_vector(memory);
    records_.push_back(r);
  }
  breaks_.clear();
  const double breaks = numerics::take(memory);
  for (double k = 0.0; k < breaks && !memory.empty(); ++k) breaks_.push_back(numerics::take(memory));
}

}  // namespace snare::coupling
