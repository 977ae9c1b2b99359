#pragma once

#include "coupling/dynamics/simulate.hpp"
#include "multibody/arm/arm_run.hpp"
#include "scenario/motion_reader.hpp"
#include "scenario/outcome.hpp"
#include "scenario/sensors.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace snare::scenario {

/// One motion of a scenario.
struct NamedMotion {
  std::string name;   ///< in messages and results: of the model, or the scenario's title
  std::string model;  ///< what stands for the wires: "wire", or a law's name
  coupling::Motion motion;
  coupling::MotionOptions options;
};

/// With what the one body meets the one wire: a cylinder along z.
struct Probe {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< p_BP of its axis [m]
  double radius = 0.0;                              ///< [m]
  double side = 1.0;                                ///< of the push along y: 1 with the wire's bulge, -1 against it
  double distance = 0.0;                            ///< to the wire at the start [m]
};

/// What pictures show of a shape or a ring: lines that a carrier takes along.
struct DrawnLines {
  std::string name;
  coupling::MotionCarrier carrier;
  multibody::Pose X_WS;                 ///< of the lines' frame at the start
  std::vector<Eigen::Matrix3Xd> lines;  ///< in that frame [m]
};

/// Motions with wires, run one after the other: kinds "contact" and "arm_contact".
struct WireMotions {
  /// Canonical text of everything that was read, files beside it too: equal for equal scenarios.
  std::string input;
  double duration = 0.0;  ///< of every run [s]
  MotionOutput output;
  /// Of one body that meets one wire, run with each of the wire's models. None: the scenario lists its bodies, wires and
  /// shapes and is one run.
  std::optional<Probe> probe;
  /// Of a scenario that lists what there is.
  bool composed = false;
  std::vector<Sensor> sensors;
  std::optional<CaptureTest> capture;
  std::vector<std::string> model_keys;  ///< of the models of a composed scenario's wires, as for `--set`
  std::vector<std::string> law_models;  ///< words of laws of which a wire has the numbers
  std::vector<DrawnLines> drawn;        ///< of a composed scenario
  std::vector<NamedMotion> runs;
};

/// A motion of an arm alone: kinds "joint_step", "tip_impulse", "joint_motion".
struct ArmMotion {
  multibody::ArmScenario scenario;
  int joint = -1;  ///< index, of a joint step
};

/// What a scenario's file says there is.                                                      docs/scenario_file.md
struct Scenario {
  std::string kind;  ///< as the file has it
  std::string title, source;
  std::variant<WireMotions, ArmMotion> content;
};

}  // namespace snare::scenario
