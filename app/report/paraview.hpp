#pragma once

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <vector>

namespace snare::app {

/// Polylines of one time for ParaView.
struct ParaviewFrame {
  double time = 0.0;                        ///< [s]
  std::vector<Eigen::Matrix3Xd> polylines;  ///< [m]
};

/// Writes NAME.pvd in `folder` and one NAME_k.vtp a frame beside it (VTK XML PolyData, ASCII).
void write_paraview(const std::filesystem::path& folder, const std::string& name,
                    const std::vector<ParaviewFrame>& frames);

}  // namespace snare::app
