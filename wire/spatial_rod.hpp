#pragma once

#include "wire/end.hpp"
#include "wire/mesh.hpp"
#include "wire/planar_rod.hpp"
#include "wire/spatial_properties.hpp"
#include "wire/spatial_state.hpp"

#include <Eigen/Core>

#include <array>

namespace snare::wire {

/// The discrete elastic rod in space.                       theory.md (W.20)-(W.30); Bergou et al. 2008, 2010
///
///   E = sum_edges 1/2 EA (l/l0 - 1)^2 l0 - sum w.x m + sum_vertices 1/2 GJ/l_i (tau_i - tau_nat l_i)^2
///     + sum_vertices [ 1/4 (k_1 + k_2) |kb|^2 + 1/4 (k_1 - k_2)(kappa_1^2 - kappa_2^2)
///                      - sum_j k_j kappa_j kn_j l_i + 1/2 sum_j k_j (kn_j l_i)^2 ],  k_j = EI_j/l_i
///
/// The bracket is 1/2 sum_j k_j (kappa_j - kn_j l_i)^2 but for kappa_1^2 + kappa_2^2 = cos^2(tau_m/2) |kb|^2
/// of the mean directors (tau_m: their angle), which is replaced by |kb|^2: a round rod then bends
/// independently of its twist, as the continuous one does, however many turns fall on a cell. In the plane it
/// is PlanarRod. (A rod with natural curvature and natural twist keeps 1/2 EI kappa_nat^2 (tau_nat l/2)^2 per
/// length in its natural state, an error of second order like the others.)
///
/// A clamp is the vertex at the mount with the mount's direction and directors as its outer
/// edge and half a cell for bending and for twisting; a twisting pin has the twisting half cell only.
class SpatialRod {
 public:
  static constexpr int dimension = 3;
  static constexpr int block = SpatialState::block;
  static constexpr int angle = SpatialState::angle;
  static constexpr int half_bandwidth = 10;  ///< x_i and z_{i+2}

  SpatialRod(MaterialMesh mesh, const SpatialRodProperties& properties, Strains strains = Strains::all);

  /// The mesh that the state's controls carry.
  [[nodiscard]] const MaterialMesh& mesh() const noexcept { return mesh_; }
  /// The constants that it was made with.
  [[nodiscard]] const SpatialRodProperties& properties() const noexcept { return properties_; }
  /// Number of unknowns q, held ones with them.
  [[nodiscard]] int unknowns() const noexcept { return block * mesh_.vertices(); }
  /// First unknown of the vertex at an end.
  [[nodiscard]] int row_of(End end) const noexcept { return end == End::left ? 0 : block * mesh_.edges(); }

  /// Moves or turns the mounts; bring a state along with `adopt_mounts`.
  void set_mounts(const SpatialEnd& left, const SpatialEnd& right);

  /// A state with these unknowns. Its reference frames run from the left mount (or from any normal) to the
  /// right without turning about the wire, so that theta is counted from there; at the right mount the
  /// reference twist is in (-pi, pi]. q [m, rad].
  [[nodiscard]] SpatialState make_state(const Eigen::VectorXd& q, const Controls& controls) const;

  /// The straight, untwisted state between the two mounts' positions, every vertex at its share.
  [[nodiscard]] SpatialState straight_state(const Controls& controls) const;

  /// Brings a state to mounts that were moved: sets the rigidly held positions and the mounts' frames. A
  /// mount may turn about its axis by less than pi at once through its director, by any angle through its
  /// twist angle.
  void adopt_mounts(SpatialState& state) const;

  /// Which strains have energy.
  [[nodiscard]] Strains strains() const { return strains_; }

  /// Energy [J] alone.
  [[nodiscard]] double energy(const SpatialState& state) const;

  /// Everything at once into `out`, whose storage is reused. wanted[k]: fill control_columns[k].
  /// Springs of the mounts are in; rigidly held unknowns are not yet applied, so that the gradient there is
  /// the reaction: see `hold_mounts`. The Hessian is that of the energy with frames carried from this state.
  void assemble(const SpatialState& state, const std::array<bool, 3>& wanted, RodAssembly& out) const;

  /// Holds the rigid positions and the unused last angle: gradient entries of held unknowns become zero,
  /// their rows and columns those of the identity. When neither mount holds the twist, a spin of the whole
  /// rod about itself stays free: the caller must hold it.
  void hold_mounts(RodAssembly& assembly) const;

  /// Gradient and Hessian of the cell at one end (bending and twisting against the mount) by the edge beside
  /// it and its angle: at the left end those of the edge after, at the right end those of the edge before.
  struct EndCell {
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();  ///< by the edge vector [N], by the angle [N m]
    Eigen::Matrix4d hessian = Eigen::Matrix4d::Zero();
  };
  [[nodiscard]] EndCell end_cell(const SpatialState& state, End end) const;
  /// Adds energy and gradient of that cell and of a mount that gives.
  void add_end_forces(const SpatialState& state, End end, RodAssembly& out) const;

  /// Moment vector of every vertex, (3, vertices) [N m]: dE by a rigid rotation of all that follows the
  /// vertex, which is the moment that the part after it exerts on the part before; positive about z for
  /// turning left in the plane, with the torque as component along the wire. The end columns belong to the
  /// mounts.                                                                              theory.md (W.29)
  [[nodiscard]] Eigen::Matrix3Xd moments(const SpatialState& state) const;
  /// The end columns of `moments`: the couple of the left mount on the rod is minus the first, that of the
  /// right mount the second [N m].
  [[nodiscard]] std::array<Eigen::Vector3d, 2> end_moments(const SpatialState& state) const;
  /// Twisting moment of every vertex [N m], positive for a right-handed turn along the wire.
  [[nodiscard]] Eigen::VectorXd torques(const SpatialState& state) const;
  /// Axial force of every edge [N], tension positive.
  [[nodiscard]] Eigen::VectorXd tensions(const SpatialState& state) const;

 private:
  MaterialMesh mesh_;
  SpatialRodProperties properties_;
  Strains strains_;
};

}  // namespace snare::wire
