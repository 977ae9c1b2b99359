#pragma once

#include "coupling/dynamics/run/simulate.hpp"
#include "scenario/motion_reader.hpp"
#include "scenario/outcome.hpp"
#include "scenario/sensors.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::scenario {

/// One motion of a scenario.
struct NamedMotion {
  std::string name;   ///< in messages and results: of the model, or the scenario's title
  std::string model;  ///< what stands for the wires: "wire", or a law's name
  coupling::Motion motion;
  coupling::MotionOptions options;
  /// About what was read as it stands and likely meant otherwise: units of meshes and arms.
  std::vector<std::string> warnings;
};

/// What pictures show of a shape or a ring: lines that a carrier takes along.
struct DrawnLines {
  std::string name;
  coupling::MotionCarrier carrier;
  multibody::Pose X_WS;                 ///< of the lines' frame at the start
  std::vector<Eigen::Matrix3Xd> lines;  ///< in that frame [m]
};

/// What moves, with what is asked of it: one run, or one for each of the models that are compared.
struct WireMotions {
  /// Canonical text of everything that was read, files beside it too: equal for equal scenarios.
  std::string input;
  double duration = 0.0;  ///< of every run [s]
  MotionOutput output;
  std::vector<Sensor> sensors;
  std::optional<CaptureTest> capture;
  std::optional<std::pair<int, int>> swinging;  ///< arm, and joint of it of which the swings are told
  std::vector<std::string> model_keys;          ///< of the models of the wires, as for `--set`
  std::vector<std::string> law_models;          ///< words of laws of which a wire has the numbers
  std::vector<DrawnLines> drawn;
  std::vector<NamedMotion> runs;
  /// With `output.modes`: the first run on wires of half as many elements; none where no wire has elements.
  std::optional<coupling::Motion> on_half_mesh;
};

/// What a scenario's file says there is.
/// docs/scenario_file.md
struct Scenario {
  std::string title, source;
  WireMotions motions;
};

}  // namespace snare::scenario
