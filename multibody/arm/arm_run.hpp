#pragma once

#include "multibody/arm/arm_part.hpp"
#include "numerics/ida.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace snare::multibody {

/// What is to be simulated.
struct ArmScenario {
  ElasticArm arm;
  ArmState initial;
  std::vector<Drive> drives;          ///< at the start, one an elastic joint
  std::vector<DriveSwitch> switches;  ///< in the order of their times
  std::vector<TimedLoad> loads;
  double begin = 0.0, end = 1.0;  ///< [s]
  double sample = 0.01;           ///< interval of the history [s], > 0
  numerics::IdaOptions ida;
  ArmTolerances tolerances;
  double least_advance = 0.0;  ///< what a window of work must bring [s], >= 0; 0: nothing.   theory.md (M.30)
  std::function<void(double)> progress;  ///< told every sample's time [s]
  std::function<bool()> stop;            ///< asked after every step; true: stop here
};

/// One line of the history.
struct ArmSample {
  double time = 0.0;  ///< [s]
  ArmState state;
  Eigen::VectorXd deflection;    ///< of the elastic joints [rad]
  Eigen::VectorXd joint_torque;  ///< of springs with their dampers, on the motors [N m]
  Eigen::VectorXd drive_torque;  ///< [N m]
  double energy = 0.0;           ///< kinetic, potential, elastic [J]
  ArmWork work;
  Wrench momentum;  ///< of the tree, about the world's origin
};

/// Something that the integration stopped for.
struct ArmEvent {
  double time = 0.0;  ///< [s]
  int joint = -1;     ///< -1: all
  std::string what;   ///< "spring", "friction", "servo limit", "switch"
};

/// What came of it. On failure of the integration the samples reached so far are there.
struct ArmHistory {
  std::vector<ArmSample> samples;
  std::vector<ArmEvent> events;
  numerics::IdaReport report;
  numerics::IdaStatistics statistics;
  /// Largest |E - E0 - works + losses| over the largest of |E|, works and losses [-].        theory.md (A.15)
  double energy_error = 0.0;
};

/// Integrates the arm with IDA from event to event. Throws std::invalid_argument for sizes that do not fit.
[[nodiscard]] ArmHistory simulate(const ArmScenario& scenario);

}  // namespace snare::multibody
