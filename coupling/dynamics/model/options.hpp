#pragma once

#include <functional>
#include <limits>
#include <optional>

namespace snare::coupling {

/// How a motion is integrated.
struct MotionOptions {
  double duration = 1.0;          ///< [s], > 0
  double output_interval = 1e-3;  ///< of the samples [s], > 0
  /// What a step may err by: the mean over a wire's vertices, over a body's components.      theory.md (M.12)
  double relative_tolerance = 1e-6;  ///< of velocities, forces and what else is no coordinate [-]
  double position_tolerance = 3e-7;  ///< of wires [m]
  double velocity_tolerance = 3e-3;  ///< of wires with waves [m/s]
  /// Of wires without [m/s]. Written so that stored captures keep their last digits, and with them their
  /// steps.
  double quasi_static_velocity_tolerance = 3e-4 / 3.0;
  double twist_tolerance = 1e-6;          ///< of wires [rad]
  double body_position_tolerance = 1e-8;  ///< [m]
  double body_velocity_tolerance = 1e-6;  ///< [m/s]
  double angle_tolerance = 1e-7;          ///< of bodies' quaternions [rad]
  double spin_tolerance = 1e-5;           ///< of bodies [rad/s]
  double force_tolerance = 1.0;  ///< [N], of multipliers: for the Newton iteration only  theory.md (M.12)
  std::optional<int> max_order;  ///< of IDA, 1 to 5; none: by what moves, theory.md (M.2)
  /// Of these tolerances that Newton's method may leave at a step, in (0, 1); none: by what moves, theory.md
  /// (M.12).
  std::optional<double> newton_share;
  double max_step = std::numeric_limits<double>::infinity();  ///< [s]; no touch is missed without one
  /// Of the mean that is reported as peak force [s], >= 0; 1e-4 is an instrument of 10 kHz.  theory.md (M.10)
  double peak_window = 1e-4;
  /// At every multiple of this the integration starts again at first order from what a MotionState holds, so
  /// that going on from there gives the same bits as having gone through [s], > 0.
  double checkpoint_interval = std::numeric_limits<double>::infinity();
  /// Simulated time that a window of evaluations must bring [s], >= 0: a run of which it brings less has
  /// stalled and is given up, after half a minute or so of a core; see numerics::Progress.   theory.md (M.30)
  double least_advance = 0.0;
  bool wire_loads = false;  ///< samples have the velocities and section loads of the wires, see WireLoads
  /// Asked after every step; true: stop. The observer is asked at output times only.
  std::function<bool()> stop;
};

}  // namespace snare::coupling
