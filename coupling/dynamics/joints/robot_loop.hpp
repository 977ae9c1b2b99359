#pragma once

#include "coupling/dynamics/model/model.hpp"

#include <Eigen/Core>

#include <deque>
#include <functional>
#include <span>
#include <vector>

namespace snare::coupling {

/// The course of a body that a robot moves by the force it measures, late.                   theory.md (M.32)
///
/// Impulse and force at the integrator's steps and at quarters of them, between these the cubic that has both
/// at both ends; no step is longer than the delay, so that what a step asks for has always been measured.
/// What starts again in the motion, or touches, does so again in the course a delay later.
class RobotLoop {
 public:
  /// The body stays the caller's and outlives it.
  explicit RobotLoop(const MotionBody& body) : body_(body) {}
  RobotLoop(const RobotLoop&) = delete;
  RobotLoop& operator=(const RobotLoop&) = delete;
  ~RobotLoop() = default;

  /// The body with its course, which asks this loop: it must outlive what it is given to.
  [[nodiscard]] MotionBody moved() const;
  /// Force on the body at a time [s] within the step that has just been made [N].
  using Force = std::function<Eigen::Vector3d(double time)>;
  /// A step from a time to another [s], or none where they are one: what presses on the body. The integrator
  /// does not watch the error of an integral of the force, so it is taken by Simpson's rule on quarters of
  /// the step.
  void sense_forces(double from, double to, const Force& force);
  [[nodiscard]] const MotionRobot& robot() const { return *body_.robot; }
  /// The integration has come to a time [s]; anew: it starts again there. Whether it must, as it did a delay
  /// earlier.
  [[nodiscard]] bool begin_interval(double time, bool anew);
  /// The first time after a time at which it must [s]; infinite: none.
  [[nodiscard]] double next_break(double time) const;
  [[nodiscard]] double longest_step() const { return body_.robot->delay; }

  /// Of the course at a time [s].
  [[nodiscard]] Eigen::Vector3d velocity(double time) const;      ///< [m/s]
  [[nodiscard]] Eigen::Vector3d acceleration(double time) const;  ///< [m/s^2]

  /// Appends the records that are kept, in SI units.
  void save_state(std::vector<double>& memory) const;
  /// Takes them, in SI units, from the front of `memory`.
  void restore_state(std::span<const double>& memory);

 private:
  struct Record {
    double time = 0.0;  ///< [s]
    Eigen::Vector3d impulse = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
  };
  /// The stretch of the records about a time, and the share of it that has passed; nothing before the first.
  struct Stretch {
    const Record *from = nullptr, *to = nullptr;
    double share = 0.0;
  };
  [[nodiscard]] Stretch stretch(double time) const;

  const MotionBody& body_;
  std::deque<Record> records_;
  std::deque<double> breaks_;  // times at which the integration started again, a delay later
};

}  // namespace snare::coupling
