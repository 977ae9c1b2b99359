#include "base/index.hpp"
#include "coupling/dynamics/model/modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::coupling {

using base::at;
using Eigen::Index;
using Eigen::VectorXcd;

namespace {

/// The columns of a wire's shape where a coarser mesh has its vertices, by linear interpolation.
Eigen::Matrix3Xcd on_vertices(const Eigen::Matrix3Xcd& wire, Index vertices) {
  Eigen::Matrix3Xcd result(3, vertices);
  for (Index i = 0; i < vertices; ++i) {
    const double place = static_cast<double>(i * (wire.cols() - 1)) / static_cast<double>(vertices - 1);
    const Index before = std::min(static_cast<Index>(place), wire.cols() - 2);
    const double share = place - static_cast<double>(before);
    result.col(i) = (1.0 - share) * wire.col(before) + share * wire.col(before + 1);
  }
  return result * std::sqrt(static_cast<double>(wire.cols()) / static_cast<double>(vertices));
}

/// All of a shape as one vector of norm one, the wires on the meshes of another shape.
VectorXcd unit_vector(const ModeShape& shape, const ModeShape& meshes) {
  Index size = shape.bodies_and_arms.size();
  for (const Eigen::Matrix3Xcd& wire : meshes.wires) size += wire.size();
  VectorXcd all(size);
  Index next = shape.bodies_and_arms.size();
  all.head(next) = shape.bodies_and_arms;
  for (std::size_t w = 0; w < meshes.wires.size(); ++w) {
    const Index vertices = meshes.wires[w].cols();
    if (vertices == 0) continue;
    all.segment(next, 3 * vertices) = on_vertices(shape.wires[w], vertices).reshaped();
    next += 3 * vertices;
  }
  return all.normalized();
}

/// Modes whose frequencies are the same: any mixture of them is a mode, too.
struct Cluster {
  double frequency = 0.0;   // mean [Hz]
  Eigen::MatrixXcd shapes;  // orthonormal columns
};

std::vector<Cluster> clusters_of(const SmallMotions& coarse) {
  constexpr double same = 1e-3;
  std::vector<Cluster> clusters;
  const std::vector<MotionMode>& modes = coarse.modes;
  for (std::size_t first = 0, end = 0; first < modes.size(); first = end) {
    end = first + 1;
    while (end < modes.size() &&
           modes[end].frequency - modes[end - 1].frequency <= same * modes[end].frequency)
      ++end;
    Cluster cluster;
    Eigen::MatrixXcd shapes;
    for (std::size_t k = first; k < end; ++k) {
      cluster.frequency += modes[k].frequency / static_cast<double>(end - first);
      VectorXcd one = unit_vector(modes[k].shape, modes[k].shape);
      if (shapes.cols() > 0) one -= shapes * (shapes.adjoint() * one);
      constexpr double independent = 1e-6;
      if (one.norm() < independent) continue;
      shapes.conservativeResize(one.size(), shapes.cols() + 1);
      shapes.rightCols(1) = one.normalized();
    }
    cluster.shapes = std::move(shapes);
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

}  // namespace

void add_mesh_errors(SmallMotions& fine, const SmallMotions& coarse) {
  constexpr double alike = 0.5;      // least share of a shape that lies in a cluster
  constexpr double remainder = 3.0;  // (2^2 - 1): of a second-order error
  if (coarse.modes.empty()) return;
  const std::vector<Cluster> clusters = clusters_of(coarse);
  for (MotionMode& mode : fine.modes) {
    const VectorXcd shape = unit_vector(mode.shape, coarse.modes.front().shape);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Cluster& cluster : clusters) {
      if ((cluster.shapes.adjoint() * shape).squaredNorm() >= alike)
        nearest = std::min(nearest, std::abs(cluster.frequency - mode.frequency));
    }
    if (std::isfinite(nearest)) mode.mesh_error = nearest / remainder;
  }
}

}  // namespace snare::coupling
