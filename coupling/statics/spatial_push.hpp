#pragma once

#include "coupling/statics/push_setup.hpp"
#include "coupling/statics/push_solver.hpp"
#include "wire/spatial_rod.hpp"

#include <algorithm>

namespace snare::coupling {

/// The point of contact between a wire and a straight pin of any direction.          theory.md (C.10)
///
/// The common normal of the wire's tangent t and the pin's axis a, n = side (a x t)/|a x t|; the vertex sits at
/// x = p + (R + g) n + zeta a. Across the normal the pin's surface has the directions a and c = n x a.
struct SpatialPin {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< a; unit
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(); ///< p, a point of the axis at parameter 0 [m]
  Eigen::Vector3d motion = Eigen::Vector3d::UnitY();///< d p / d travel; unit
  double side = 1.0;
  double radius = 0.0;    ///< [m], >= 0
  double friction = 0.0;  ///< Coulomb coefficient
  bool pressed = true;    ///< false: open, the gap is positive
  double last_coordinate = 0.0;                    ///< S at the last accepted state [m]
  Eigen::Vector3d last_normal = Eigen::Vector3d::UnitY();
  double last_zeta = 0.0;                          ///< [m]
};

/// Equilibrium of a spatial rod with one pin, Coulomb friction in both directions of its surface by the projection
///   f_T = P(f_T - r v),  P onto the disc of radius mu N                              theory.md (C.11)
/// (Alart and Curnier 1991), v the slip since the last accepted state: sticking is inside the disc, sliding on its rim.
/// The parameter is the travel. Border unknowns: f (3), S, g.
class SpatialPushSystem final : public numerics::PathProblem {
 public:
  static constexpr int border_unknowns = 5;

  SpatialPushSystem(const wire::SpatialRod& rod, wire::SpatialState accepted, const SpatialPin& pin_);

  SpatialPin pin;

  [[nodiscard]] wire::SpatialState state(const numerics::PathPoint& at) const;
  /// Carries the frames to an accepted point, from which the next ones are transported.
  void accept(const numerics::PathPoint& at) { accepted_ = state(at); }
  [[nodiscard]] const wire::SpatialRod& rod() const { return *rod_; }

  void assemble(const numerics::PathPoint& at, numerics::BorderedSystem& system,
                Eigen::VectorXd& by_parameter) override;
  [[nodiscard]] double error(const numerics::PathPoint& at, const numerics::BorderedSystem& system) const override;
  [[nodiscard]] double length_scale() const override { return length_; }

  [[nodiscard]] const std::array<Eigen::Vector3d, 2>& mount_reactions() const { return reactions_; }

  /// Geometry of the contact at a point.
  struct Geometry {
    Eigen::Vector3d tangent, normal, across;  ///< t, n, c
    double zeta = 0.0;
    Eigen::Vector2d slip = Eigen::Vector2d::Zero();  ///< of the wire over the pin since the last state, in (c, a) [m]
    double normal_force = 0.0;                       ///< f.n [N]
    Eigen::Vector2d friction = Eigen::Vector2d::Zero();  ///< f in (c, a) [N]
    Eigen::Vector2d trial = Eigen::Vector2d::Zero();     ///< f_T - r v [N]
  };
  [[nodiscard]] Geometry geometry(const numerics::PathPoint& at, const wire::SpatialState& state) const;
  /// Whether the friction is on the rim of its disc.
  [[nodiscard]] bool slides(const Geometry& g) const {
    return pin.friction == 0.0 || g.trial.norm() > pin.friction * std::max(0.0, g.normal_force);
  }

 private:
  const wire::SpatialRod* rod_;
  wire::SpatialState accepted_;
  double length_;
  double shortest_edge_;
  wire::RodAssembly assembly_;
  std::array<Eigen::Vector3d, 2> reactions_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
};

/// The rod of a planar push in space: same mesh, mounts, stiffnesses; isotropic in bending.
/// weight_across: weight along z per unit length [N/m].
[[nodiscard]] wire::SpatialRod spatial_rod(const wire::PlanarRod& planar, double torsional_stiffness, double weight_across);

/// Whether a test leaves the plane of the wire: a tilted pusher, or weight across the plane.
[[nodiscard]] bool needs_space(const PushProblem& test);

/// The push by a tilted pin: like solve_push, for contact at a point between clamps or pins that do not slip.
/// Without friction a loose wire swings freely about its chord; the path starts where it has swung so that the
/// pin's force has no moment about the chord.
[[nodiscard]] PushCurve solve_spatial_push(const PushProblem& test, const PushOptions& options, int coarsening);

/// Negative eigenvalues of the rod's tangent stiffness out of the plane at a planar state: modes in which the wire
/// leaves the plane while the pusher, free along its axis, holds its point of contact in the plane. The swing
/// of an unloaded wire about its chord is neutral and not counted.
[[nodiscard]] int out_of_plane_modes(const wire::PlanarRod& rod, const wire::PlanarState& state, double torsional_stiffness);

}  // namespace snare::coupling
