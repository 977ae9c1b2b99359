#pragma once

#include "coupling/statics/push_problem.hpp"
#include "numerics/report.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::coupling {

/// Wires closed around a shaft that they hold at their common centre, their chords evenly turned about its
/// axis z.
///
/// Every wire is the wire of `wire`, pushed outward at mid-span by `seat` from first touch before the
/// friction acts: the state in which closing rings leave it. The chords lie in one plane; wires do not touch
/// each other.
struct SnareSpecification {
  /// Wire, mounts and pusher (the shaft: radius, friction); elastic, between clamps or pins
  PushProblem wire;
  int wires = 3;      ///< >= 1
  double seat = 0.0;  ///< [m], > 0
  int elements = 64;  ///< edges a wire, a multiple of 4, >= 16
};

/// One point of the shaft's way. SI units.
struct ShaftPoint {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< of the shaft from the centre [m]
  /// With which the shaft must be pushed there [N]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double energy = 0.0;      ///< elastic energy of the wires [J]
  double dissipated = 0.0;  ///< by friction so far [J], never decreasing
  int slipping = 0;         ///< wires that slide over the shaft
  int touching = 0;         ///< wires that press on it
};

/// The way that was asked with the force there; ends early where an equilibrium was not found.
struct ShaftPath {
  std::vector<ShaftPoint> points;  ///< one a displacement asked for, to where it came
  numerics::SolveReport report;
};

/// Quasi-static force of the snared shaft along a way of its axis, which stays parallel to z.
///                                                                                           theory.md (R.10)
/// way: displacements visited in order from the centre [m].
[[nodiscard]] ShaftPath move_shaft(const SnareSpecification& snare, const std::vector<Eigen::Vector3d>& way);

}  // namespace snare::coupling
