#pragma once

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <vector>

namespace snare::app {

/// One polyline with the data of its points.
struct ParaviewLine {
  enum class Kind { wire, body, arm };
  Kind kind = Kind::wire;
  int number = 0;                   ///< of the wire, of what a carrier takes along, or of the arm, from 0
  std::string name;                 ///< of the same
  Eigen::Matrix3Xd points;          ///< [m]
  Eigen::Matrix3Xd velocities;      ///< [m/s], one a point
  Eigen::Matrix3Xd contact_forces;  ///< of contacts on the wire, shared out to its points [N]; empty: none
  Eigen::VectorXd tensions;         ///< [N]; empty: 0
  Eigen::VectorXd curvatures;       ///< [1/m]; empty: 0
};

/// Polylines of one time for ParaView.
struct ParaviewFrame {
  double time = 0.0;  ///< [s]
  std::vector<ParaviewLine> lines;
};

/// Writes NAME.pvd in `folder` and one NAME_k.vtp a frame next to it (VTK XML PolyData, ASCII): coordinates
/// in metres, as the field array `coordinates_unit` says; point arrays `tension_N`, `curvature_1_m`,
/// `contact_force_N`, `velocity_m_s`; cell arrays `kind` (0 wire, 1 body, 2 arm), `number` and `name`; field
/// array `TimeValue` [s]. Throws std::system_error where a file cannot be written.
void write_paraview(const std::filesystem::path& folder, const std::string& name,
                    const std::vector<ParaviewFrame>& frames);

}  // namespace snare::app
