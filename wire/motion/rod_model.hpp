#pragma once

#include "base/index.hpp"
#include "numerics/dae.hpp"
#include "wire/curvature.hpp"
#include "wire/end.hpp"
#include "wire/motion/rod_in_motion.hpp"
#include "wire/spatial_rod.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace snare::wire {

/// What of a rod in a DAE does not change: its constants, its masses, what is held, and where its unknowns
/// are.
///
/// Vertices have positions x and velocities v, edges angles theta, with strands vertices have z as well, of
/// higher order curvatures k. The rod's own numbering, (x_0, theta_0, x_1, ...), is called band: that of its
/// Hessian.
class RodModel {
 public:
  static constexpr int block = SpatialRod::block;
  static constexpr int angle = SpatialRod::angle;

  explicit RodModel(const RodInMotion& constants);

  /// What it was made from.
  [[nodiscard]] const RodInMotion& constants() const { return constants_; }
  /// Its Kelvin-Voigt damping and drag; times of zero: none.
  [[nodiscard]] const RodDamping& damping() const { return constants_.damping; }
  /// Friction of its strands; it may be none.
  [[nodiscard]] const RodStrands& strands() const { return constants_.strands; }
  /// Whether curvatures are unknowns too: the rod of higher order.
  [[nodiscard]] bool is_curved() const { return constants_.formulation == Formulation::higher_order; }
  /// With curvatures as unknowns its twist and its weight alone.
  [[nodiscard]] const SpatialRod& rod() const { return rod_; }
  [[nodiscard]] const SpatialRodProperties& properties() const { return rod_.properties(); }
  [[nodiscard]] const Controls& controls() const { return controls_; }
  [[nodiscard]] int vertices() const { return rod_.mesh().vertices(); }
  [[nodiscard]] int edges() const { return rod_.mesh().edges(); }
  [[nodiscard]] int bands() const { return rod_.unknowns(); }
  [[nodiscard]] int vertex_at(End end) const { return end == End::left ? 0 : edges(); }
  [[nodiscard]] int edge_at(End end) const { return end == End::left ? 0 : edges() - 1; }
  /// The end that vertex i is at.
  [[nodiscard]] std::optional<End> end_of(int i) const {
    if (i == 0) return End::left;
    if (i == edges()) return End::right;
    return std::nullopt;
  }
  /// Unstretched length of an edge [m]; lumped mass of a vertex [kg].
  [[nodiscard]] double rest_length(int edge) const { return rod_.mesh().rest_length(edge, controls_); }
  [[nodiscard]] double mass_of(int vertex) const { return mass_[base::at(vertex)]; }
  /// Of the masses what resists acceleration: all, or of a quasi-static wire so little that no wave is felt,
  /// and what friction lets go still passes from one place to the next.                      theory.md (M.18)
  /// 1, or 1e-3 where it is quasi-static [-]; the mass that resists acceleration then [kg].
  [[nodiscard]] double inertial_share() const { return constants_.quasi_static ? 1e-3 : 1.0; }
  [[nodiscard]] double inertia_of(int vertex) const { return inertial_share() * mass_of(vertex); }
  /// Whether bending dissipates.
  [[nodiscard]] bool bends_with_loss() const { return damping().bending_time > 0.0 || strands().act(); }
  /// Drag on the rate of theta_0 where no mount holds the twist [N m s]; 0: none.             theory.md (M.4)
  [[nodiscard]] double spin_drag() const { return spin_drag_; }

  /// Whether component k of a vertex is rigidly held by a mount that stands still.
  [[nodiscard]] bool is_held(int vertex, int k) const { return held_[base::at(3 * vertex + k)]; }
  /// Whether theta = 0 stands instead of its balance: of no edge, or with nothing that determines it.
  [[nodiscard]] bool holds_angle(int vertex) const {
    return vertex == vertices() - 1 || (holds_first_angle_ && vertex == 0);
  }
  /// The vertex at an end is no longer held.
  void release(End end);

  /// Appends the rod's blocks, named behind `name`, to a DAE's unknowns; from here on the places below are
  /// known.
  void declare(numerics::DaeLayout& layout, const std::string& name, const RodTolerances& tolerances);
  [[nodiscard]] int position_of(int vertex) const { return x_ + 3 * vertex; }  ///< first of three
  [[nodiscard]] int velocity_of(int vertex) const { return v_ + 3 * vertex; }
  [[nodiscard]] int angle_of(int edge) const { return theta_ + edge; }
  [[nodiscard]] int strand_of(int vertex) const { return strand_ + 2 * vertex; }  ///< first of two

  /// First of the two curvatures of a vertex [1/m]; only of higher order.
  [[nodiscard]] int curvature_of(int vertex) const { return curvature_ + 2 * vertex; }

  /// Whether a band index is that of an angle theta, not of a position.
  [[nodiscard]] static bool is_angle(int band) { return band % block == angle; }
  /// Unknown x or theta of the DAE.
  [[nodiscard]] int unknown_of(int band) const {
    return is_angle(band) ? angle_of(band / block) : position_of(band / block) + band % block;
  }
  /// Unknown v that belongs to a coordinate.
  [[nodiscard]] int rate_of(int band) const { return velocity_of(band / block) + band % block; }
  /// Row of the balance of forces on a coordinate, or of moments on an angle.
  [[nodiscard]] int balance_of(int band) const { return is_angle(band) ? unknown_of(band) : rate_of(band); }
  /// Whether x = X or theta = 0 is there instead of the balance.
  [[nodiscard]] bool is_held(int band) const {
    return is_angle(band) ? holds_angle(band / block) : is_held(band / block, band % block);
  }

 private:
  RodInMotion constants_;
  SpatialRod rod_;
  Controls controls_;
  std::vector<double> mass_;
  std::vector<bool> held_;          // of 3 components a vertex
  bool holds_first_angle_ = false;  // nothing else determines the spin of the wire about itself
  double spin_drag_ = 0.0;
  int x_ = 0, theta_ = 0, v_ = 0, strand_ = 0, curvature_ = 0;
};

/// Shape and frames of a rod at one point of a motion, with what its moving mounts do.
struct RodInstant {
  SpatialState state;
  std::vector<Directors> directors;                    ///< material ones of the edges
  std::vector<double> inverse_lengths;                 ///< of the edges [1/m]
  std::array<std::optional<Eigen::Vector3d>, 2> spin;  ///< of mounts that move, in the world [rad/s]

  /// Sets what is of the edges from the state.
  void take_edges();
};

}  // namespace snare::wire
