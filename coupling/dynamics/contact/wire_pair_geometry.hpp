#pragma once

#include "coupling/dynamics/contact/bristle_means.hpp"
#include "coupling/dynamics/model/model.hpp"

#include <Eigen/Core>

#include <array>

namespace snare::coupling {

/// One of two wires at a place of its curve, and how it moves there. Derivatives by its material coordinate
/// zeta.
struct PairSide {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();        ///< X [m]
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();    ///< X' [-]
  Eigen::Vector3d bend = Eigen::Vector3d::Zero();     ///< X'' [1/m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();        ///< sum N v [m/s], zeta kept
  Eigen::Vector3d slope_v = Eigen::Vector3d::Zero();  ///< sum N' v [1/s]
  /// An edge e beside the place, which turns at e x e'/|e|^2.
  struct Edge {
    double share = 0.0;                              ///< of it in the turn of the section [-]
    double share_slope = 0.0;                        ///< derivative by zeta [1/m]
    Eigen::Vector3d edge = Eigen::Vector3d::Zero();  ///< e [m]
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< e' [m/s]
  };
  std::array<Edge, 3> edges;  ///< those between the four vertices on which the place depends

  [[nodiscard]] Eigen::Vector3d turn() const;  ///< of the section [rad/s]
};

/// Wire A at a place and the point of wire B that is nearest to it, axes of the world.
///                                                                                   theory.md (M.20), (M.21)
///
///   r = X_A - X_B,  D = |r|,  n = r/D,  g = D - r_A - r_B;   r.X_B' = 0 (B's point follows)
///   t = X_A'/|X_A'|,  o: dg/dt or dg/dt - (n.t) (t.(v_A - v_B)), the rate by motion across A,
///     or a mean of both: see Opening
///   u = X_A' - (n.X_A') n,  a = u/|u|,  b = n x a
///   w = v_A - v_B - Omega x r,   Omega = s_A omega_A + s_B omega_B,   s_A = r_A/(r_A + r_B)
///   force on A, a length of A: f = p n - (friction on B, in a and b), on B -f;
///     at one point on r, which shares it as the radii
/// do: so the section of A bears the moment s_A M, that of B s_B M, M = r x (friction on B). Its part about
/// the wire's own axis is taken as held: wires neither roll on each other nor are twisted by each other.
struct PairGeometry {
  std::array<PairSide, 2> sides;                        ///< A, B
  std::array<double, 2> shares{0.5, 0.5};               ///< s_A, s_B
  bool stands = false;                                  ///< B's point is an end of B
  Eigen::Vector3d apart = Eigen::Vector3d::Zero();      ///< r [m]
  double distance = 0.0;                                ///< D [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();     ///< n
  double gap = 0.0, gap_rate = 0.0;                     ///< g [m], dg/dt [m/s]
  Eigen::Vector3d relative = Eigen::Vector3d::Zero();   ///< v_A - v_B [m/s]
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< t
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();       ///< Omega [rad/s]
  Eigen::Vector3d sliding = Eigen::Vector3d::Zero();    ///< w, of the surfaces [m/s]
  Eigen::Vector3d along = Eigen::Vector3d::Zero(), across = Eigen::Vector3d::Zero();  ///< a, b
  double run = 0.0;                                                                   ///< |u|
  Eigen::Vector3d load = Eigen::Vector3d::Zero();  ///< p [N/m], and its derivatives by g and o
  Eigen::Vector3d elastic =
      Eigen::Vector3d::Zero();  ///< the part of p that is stored, and its first two derivatives by g
  Opening opening;              ///< o
  BristleState state;           ///< w in a and b, p and its stored part
  TangentForce friction;
  std::array<TangentForce, 2> of_bristles;           ///< of the bristles of A's element, if there are any
  std::array<double, 2> shape_functions{};           ///< shares of them in `friction`
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< f [N/m]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< M [N]

  /// Rate of the stored part of p [N/(m s)].
  [[nodiscard]] double elastic_rate() const { return elastic[1] * gap_rate; }
  /// A vector given in the tangent plane's axes a and b, in the axes of the world; same unit.
  [[nodiscard]] Eigen::Vector3d in_world(const Eigen::Vector2d& tangent) const {
    return tangent.x() * along + tangent.y() * across;
  }
};

/// pair: its foundation has a modulus. radii: of A and B [m]. beside: used only where friction has bristles.
[[nodiscard]] PairGeometry pair_geometry(const WirePair& pair, const std::array<double, 2>& radii,
                                         const std::array<PairSide, 2>& sides, bool stands,
                                         const BristlesBeside& beside);

/// A direction in the space of what the contact depends on: of sums over vertices, zeta kept.
struct PairDirection {
  struct Side {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();      ///< of X
    Eigen::Vector3d slope = Eigen::Vector3d::Zero();  ///< of X'
    Eigen::Vector3d v = Eigen::Vector3d::Zero();      ///< of sum N v
    std::array<Eigen::Vector3d, 3> edge{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                        Eigen::Vector3d::Zero()};
    std::array<Eigen::Vector3d, 3> rate{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                        Eigen::Vector3d::Zero()};
  };
  std::array<Side, 2> sides;
  std::array<Eigen::Vector2d, 2> bristles{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
};

/// What changes along a direction.
struct PairChange {
  double zeta = 0.0;                 ///< of B's point [m]
  double load = 0.0, elastic = 0.0;  ///< of p and of its stored part [N/m]
  double elastic_rate = 0.0;         ///< of the rate of that [N/(m s)]
  Eigen::Vector2d sliding = Eigen::Vector2d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< of f
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< of M
};
/// How load, force and moment change along `d` at the place `g`, B's point following: the first derivative of
/// pair_geometry, linear in d.
[[nodiscard]] PairChange pair_change(const MotionFriction& friction, const PairGeometry& g,
                                     const PairDirection& d);

/// What a moment m [N m] on an edge e [m] is as forces [N] on its vertices, but for its part about the edge:
/// (m x e)/|e|^2 on the second, the opposite on the first.
[[nodiscard]] Eigen::Vector3d couple_on(const Eigen::Vector3d& edge, const Eigen::Vector3d& moment);
/// Its change with that of the edge and of the moment [N].
[[nodiscard]] Eigen::Vector3d couple_change(const Eigen::Vector3d& edge, const Eigen::Vector3d& moment,
                                            const Eigen::Vector3d& edge_change,
                                            const Eigen::Vector3d& moment_change);

}  // namespace snare::coupling
