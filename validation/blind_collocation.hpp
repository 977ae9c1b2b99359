#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "validation/blind_section.hpp"
#include "validation/blind_wire.hpp"

namespace snare::validation::blind {

enum class Grip { smooth, sticking, sliding };

/// What holds the wire in one solve.
struct Conditions {
  double span = 0.0;                                 ///< [m]
  Eigen::Vector2d weight = Eigen::Vector2d::Zero();  ///< [N/m]
  Eigen::Vector2d pusher = Eigen::Vector2d::Zero();  ///< its axis, were it rigid [m]
  double slope = 0.0;                                ///< sliding: f . t over f . nu [-]
  double anchor = 0.0;                               ///< sticking: S_c + R th_c [m]
  double feed_limit = 0.0;                           ///< slipping: C, or the force along the chord [N]
  double begin = 0.0;  ///< not slipping: S_0, or where the left mount stands [m]
  double rate = 0.0;   ///< relaxation time over time step [-]
  Grip grip = Grip::smooth;
  bool touching = false;  ///< otherwise S_c follows the pusher without a force
  bool feeding = false;   ///< the left mount slips
  bool slides = false;    ///< it does so along the chord, with the wire in it
};

/// Unknowns of the collocated elastica.
struct Unknowns {
  std::vector<std::array<double, 2>> section;   ///< th [rad] and M [N m] in the nodes
  Eigen::Vector2d n = Eigen::Vector2d::Zero();  ///< force in the section at S_0 [N]
  Eigen::Vector2d f = Eigen::Vector2d::Zero();  ///< pusher on wire [N]
  double contact = 0.0;                         ///< S_c [m]
  double begin = 0.0;                           ///< S_0 [m]
  double place = 0.0;                           ///< of the left mount along the chord [m]
};

/// Planar extensible elastica by Hermite-Simpson collocation (Lobatto IIIA, fourth order) on either side of
/// the contact. n is affine in S and r an integral, so only th and M are unknown in the nodes:
///   th' = kappa(M, S),  M' = -(1 + e(N, S)) n . nu(th),  n = n_0 - w (S - S_0) - [S > S_c] f
/// with the globals n_0, f, S_c, S_0 (of a mount that slides its place instead) and six conditions on r and
/// on contact, friction and mount. The mesh is stretched with S_0 and S_c. Newton with the analytic Jacobian:
/// the nodes' band is eliminated by pivoting (which keeps boundary layers stable), the globals by their Schur
/// complement.
class Collocation {
 public:
  /// The mesh for a wire that is touched at about this unstressed coordinate [m].
  Collocation(const BlindWire& wire, double contact);

  [[nodiscard]] std::size_t nodes() const { return left_ + right_ + 1; }  ///< of the whole wire
  [[nodiscard]] std::size_t contact_node() const { return left_; }        ///< where the pusher is

  /// Fraction of the way from S_0 to S_c, or from S_c to L, of a node; the coordinate of a node [m].
  [[nodiscard]] double coordinate(const Unknowns& z, std::size_t node) const;

  /// Newton from z. False where it does not converge; z is then of no use.
  [[nodiscard]] bool solve(const Section& law, const Conditions& at, Unknowns& z);

  /// Position of the touched section of a solution of this object's last solve [m].
  [[nodiscard]] Eigen::Vector2d contact_position() const { return contact_position_; }

  /// Lets every material point of the wire between the mounts remember the solution.
  void remember(Section& law, const Conditions& at, const Unknowns& z) const;

 private:
  static constexpr std::size_t kGlobals = 6;             // n_x, n_y, f_x, f_y, S_c, S_0
  static constexpr std::size_t kColumns = kGlobals + 1;  // and the residual
  using Column = std::array<double, kColumns>;
  using Square = Eigen::Matrix<double, 6, 6>;
  using Globals = Eigen::Matrix<double, 6, 1>;
  struct Point;
  struct Side;

  [[nodiscard]] Point evaluate(const Section& law, const Conditions& at, const Side& side, double S,
                               double fraction, const std::array<double, 2>& u, double guess) const;
  void assemble(const Section& law, const Conditions& at, const Unknowns& z);
  /// Interval i, from its first point at `fraction` of the side; returns its last one.
  Point add_interval(const Section& law, const Conditions& at, const Unknowns& z, const Side& side,
                     std::size_t i, double fraction, const Point& a);
  void add_interval_globals(const std::array<Point, 3>& points, double h, const std::array<double, 4>& dh,
                            const std::array<double, 2>& du, bool right, std::size_t i);
  void close(const Section& law, const Conditions& at, const Unknowns& z, Square& by_global,
             Globals& residual);
  [[nodiscard]] bool eliminate();
  [[nodiscard]] double apply(const Square& by_global, const Globals& residual, Unknowns& z);

  double length_;
  double radius_;
  double axial_;
  double mount_axial_;
  double mount_rotational_;
  double pusher_compliance_;
  Eigen::Vector2d direction_;
  double force_scale_;
  double moment_scale_;
  bool slides_ = false;  // of the conditions under way
  std::size_t left_ = 0;
  std::size_t right_ = 0;
  std::vector<double> fraction_;             // of the nodes, the contact's as the end of the left side
  std::vector<double> guess_;                // curvatures: node, middle, node, ...
  std::vector<std::array<double, 7>> band_;  // row i holds columns i-2 ... i+4
  std::vector<Column> columns_;              // right-hand sides, then the solution
  std::vector<std::array<std::array<double, 2>, 4>> arm_;  // d(x_c, y_c, x_L - x_c, y_L - y_c)/d(th, M)
  std::array<Column, 4> arm_global_{};                     // the same by the globals; last: the value
  std::array<std::array<double, 6>, 6> close_node_{};      // of a global row: th_0, M_0, th_c, M_c, th_L, M_L
  std::array<std::array<double, 4>, 6> close_arm_{};       // of a global row: the four integrals
  Eigen::Vector2d contact_position_ = Eigen::Vector2d::Zero();
};

}  // namespace snare::validation::blind
