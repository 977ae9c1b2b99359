#pragma once

#include "coupling/contact/curve.hpp"
#include "numerics/path.hpp"
#include "wire/spatial_rod.hpp"

#include <algorithm>
#include <array>

namespace snare::coupling {

/// The point of contact between a wire and a straight pin of any direction.          theory.md (C.10)
///
/// The common normal of the wire's tangent t and the pin's axis a, n = side (a x t)/|a x t|; the vertex sits
/// at x = p + (R + g) n + zeta a. Across the normal the pin's surface has the directions a and c = n x a.
struct SpatialPin {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();    ///< a; unit
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< p, a point of the axis at parameter 0 [m]
  Eigen::Vector3d motion = Eigen::Vector3d::UnitY();  ///< d p / d travel; unit
  double side = 1.0;
  double radius = 0.0;           ///< [m], >= 0
  double friction = 0.0;         ///< Coulomb coefficient
  bool pressed = true;           ///< false: open, the gap is positive
  double last_coordinate = 0.0;  ///< S at the last accepted state [m]
  Eigen::Vector3d last_normal = Eigen::Vector3d::UnitY();
  double last_zeta = 0.0;  ///< [m]
};

/// Equilibrium of a spatial rod with one pin, Coulomb friction in both directions of its surface by the
/// projection
///   f_T = P(f_T - r v),  P onto the disc of radius mu N                              theory.md (C.11)
/// (Alart and Curnier 1991), v the slip since the last accepted state: sticking is inside the disc, sliding
/// on its rim. The parameter is the travel.
class SpatialPushSystem final : public numerics::PathProblem {
 public:
  static constexpr int border_unknowns = 5;
  /// Places in the border: of its unknowns (columns), and of its equations (rows).
  struct Rows {
    static constexpr int force = 0;       ///< f, in the world's axes (3) [N]
    static constexpr int coordinate = 3;  ///< S: material coordinate of the contact vertex [m]
    static constexpr int gap = 4;         ///< g [m]

    static constexpr int position = 0;  ///< across the axis, x - p - (R + g) n = 0 (2)
    static constexpr int friction = 2;  ///< along c and a, the projection above (2)
    static constexpr int closure = 4;   ///< g = 0. An open contact has f = 0 in `friction` and here.
  };

  SpatialPushSystem(const wire::SpatialRod& rod, wire::SpatialState accepted, const SpatialPin& pin_);

  SpatialPin pin;

  /// The rod's state at a point of the path, frames carried from the accepted one.
  [[nodiscard]] wire::SpatialState state(const numerics::PathPoint& at) const;
  /// Carries the frames to an accepted point, from which the next ones are transported.
  void accept(const numerics::PathPoint& at) { accepted_ = state(at); }
  /// The state at the accepted point; to be given to `restore` where steps are taken back.
  [[nodiscard]] const wire::SpatialState& accepted() const { return accepted_; }
  void restore(const wire::SpatialState& accepted) { accepted_ = accepted; }
  [[nodiscard]] const wire::SpatialRod& rod() const { return *rod_; }
  /// Force of the pin on the wire [N].
  [[nodiscard]] static Eigen::Vector3d force(const numerics::PathPoint& at) {
    return at.border.segment<3>(Rows::force);
  }
  /// Slope of the curve of contact at the contact vertex.
  [[nodiscard]] VertexSlope<3> slope(const wire::SpatialState& state) const;

  /// PathProblem: equilibrium of the rod under f, and the equations in Rows.         theory.md (C.10), (C.11)
  void assemble(const numerics::PathPoint& at, numerics::BorderedSystem& system,
                Eigen::VectorXd& by_parameter) override;
  [[nodiscard]] double error(const numerics::PathPoint& at,
                             const numerics::BorderedSystem& system) const override;
  [[nodiscard]] double length_scale() const override { return length_; }

  /// Reactions of the mounts on the wire at the last assembly: left, right [N].
  [[nodiscard]] const std::array<Eigen::Vector3d, 2>& mount_reactions() const { return reactions_; }

  /// Geometry of the contact at a point.
  struct Geometry {
    Eigen::Vector3d tangent, normal, across;  ///< t, n, c
    double zeta = 0.0;
    /// Of the wire over the pin since the last state, in (c, a) [m]
    Eigen::Vector2d slip = Eigen::Vector2d::Zero();
    double normal_force = 0.0;                           ///< f.n [N]
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

}  // namespace snare::coupling
