#pragma once

#include <Eigen/Dense>

#include "numerics/report.hpp"
#include "validation/elastica_flow.hpp"
#include "validation/elastica_problem.hpp"

/// Multiple-shooting equations behind elastica_push.hpp; not meant for use by itself.
namespace snare::validation::shooting {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The last equation, which picks one state of the path.
enum class Control { no_force, height, arc_length };

/// What the last equation asks for. All dimensionless.
struct Demand {
  Control control = Control::no_force;
  double height = 0.0;  // of the pusher, over L
  VectorXd direction;   // arc length: row of the equation direction . (z - origin) = step
  VectorXd origin;
  double step = 0.0;
};

/// The equations at one z, and their derivatives by z; as many as unknowns. All dimensionless.
struct System {
  VectorXd residual;
  MatrixXd jacobian;
  Index row = 0;  ///< the next one to be written

  /// z[column] = value.
  void hold(const VectorXd& z, Index column, double value) {
    residual[row] = z[column] - value;
    jacobian(row++, column) = 1.0;
  }
};

/// The section at the end of a piece, with its derivatives by z: rows x, y, angle, moment.
struct PieceEnd {
  ElasticaSection section{};
  MatrixXd by;
};

// Unknowns z, dimensionless: the sections at the start of every piece (left side, then right side), n on the
// left, n on the right, unstressed arc length of the contact (point: one; wrapped: both lift-off points),
// height of the pusher. Lengths in units of L, forces in EI/L^2.
class Shooting {
 public:
  explicit Shooting(const ElasticaPush& problem)
      : pieces_(problem.pieces_per_side),
        contact_(problem.contact),
        ends_(problem.ends),
        sigma_(problem.side == ElasticaSide::with_bulge ? 1.0 : -1.0),
        span_(problem.span / problem.wire.length),
        position_(problem.position / problem.wire.length),
        radius_(problem.radius / problem.wire.length),
        slope_(problem.friction_slope),
        material_(problem.material_coordinate / problem.wire.length) {
    const ElasticaWire& w = problem.wire;
    law_.compliance = w.bending_stiffness / (w.axial_stiffness * w.length * w.length);
    law_.natural_curvature = w.natural_curvature * w.length;
    mount_axial_ = problem.mount_axial_compliance * w.bending_stiffness / (w.length * w.length * w.length);
    mount_rotational_ = problem.mount_rotational_compliance * w.bending_stiffness / w.length;
  }

  /// Number of unknowns and of equations; `wrapped`: the wire lies on the pusher over an arc.
  [[nodiscard]] Index size(bool wrapped) const { return 8 * pieces_ + (wrapped ? 7 : 6); }
  /// First of the two unknowns of n on the left, and of those on the right.
  [[nodiscard]] Index left_force() const { return 8 * pieces_; }
  [[nodiscard]] Index right_force() const { return 8 * pieces_ + 2; }
  /// Unknown of the unstressed arc length at the contact, or at its two ends where it is wrapped.
  [[nodiscard]] Index begin() const { return 8 * pieces_ + 4; }
  [[nodiscard]] Index end(bool wrapped) const { return 8 * pieces_ + (wrapped ? 5 : 4); }
  /// Unknown of the pusher's height.
  [[nodiscard]] Index height(bool wrapped) const { return 8 * pieces_ + (wrapped ? 6 : 5); }
  /// Pieces on either side of the contact.
  [[nodiscard]] int pieces() const { return pieces_; }
  /// +1: the pusher comes with the bulge, -1: against it.
  [[nodiscard]] double sigma() const { return sigma_; }
  /// Compliance and natural curvature, over L.
  [[nodiscard]] const ElasticaLaw& law() const { return law_; }

  /// The section at the start of a piece, as z has it; and the force of which the first component is unknown
  /// `at`.
  [[nodiscard]] static ElasticaSection section(const VectorXd& z, Index piece) {
    return {z[4 * piece], z[4 * piece + 1], z[4 * piece + 2], z[4 * piece + 3]};
  }
  [[nodiscard]] static ElasticaForce force(const VectorXd& z, Index at) { return {z[at], z[at + 1]}; }

  // Geometric curvature of the wire at the point contact over the cylinder's, 1 where the wire begins to
  // wrap.
  [[nodiscard]] double relative_curvature(const VectorXd& z) const {
    const ElasticaSection p = section(z, pieces_);
    const double tension = section_forces(force(z, left_force()), p.angle).tension;
    return -sigma_ * radius_ * (law_.natural_curvature + p.moment) / (1.0 + law_.compliance * tension);
  }

  /// Equations and their derivatives at z.
  [[nodiscard]] System assemble(const VectorXd& z, bool wrapped, const Demand& demand) const;
  /// Newton's method from z, halved on the residual; z is the solution when the report is usable.
  [[nodiscard]] numerics::SolveReport solve(VectorXd& z, bool wrapped, const Demand& demand) const;
  /// Sign of the Jacobian's determinant under control of the height (over L): it changes where a fold is
  /// passed.
  [[nodiscard]] bool determinant_positive(const VectorXd& z, bool wrapped, double height) const;
  /// The unloaded wire at its touch: z becomes the buckled, or the straight, shape without a force.
  [[nodiscard]] numerics::SolveReport start(VectorXd& z);

 private:
  /// x = c n_x, y = 0, and angle = c_r M or moment zero.
  void add_left_mount(const VectorXd& z, System& sys) const;
  /// x = span - c n_x, y = 0, and angle = -c_r M or moment zero.
  void add_right_mount(const VectorXd& z, const PieceEnd& end, System& sys) const;
  [[nodiscard]] PieceEnd end_of(const VectorXd& z, Index piece, bool wrapped) const;
  /// What a piece meets: the next one, the right mount, or the cylinder that the wire wraps.
  void add_piece_end(const VectorXd& z, Index piece, bool wrapped, System& sys) const;
  void add_lift_off(const VectorXd& z, const PieceEnd& end, System& sys) const;
  /// Contact at the start of the right side.
  void add_contact(const VectorXd& z, bool wrapped, Control control, System& sys) const;
  /// along_x f_x + along_y f_y = 0 of the force on the pusher, in the present row.
  void write_force_row(const VectorXd& z, double along_x, double along_y, System& sys) const;
  void add_demand(const VectorXd& z, bool wrapped, const Demand& demand, System& sys) const;
  [[nodiscard]] VectorXd buckled_guess(double excess) const;
  [[nodiscard]] VectorXd straight_guess() const;
  /// Buckling load of the straight wire.
  [[nodiscard]] double critical() const;
  [[nodiscard]] double first_position() const {
    return contact_ == ElasticaContact::material_point ? material_ * span_ : position_;
  }

  int pieces_;
  ElasticaContact contact_;
  ElasticaEnds ends_;
  double sigma_;
  double span_;
  double position_;
  double radius_;
  double slope_;
  double material_;  // contact's arc length, when it is given or has been found by the first touch
  double mount_axial_ = 0.0, mount_rotational_ = 0.0;  // compliances over those of the wire, L^3/EI and L/EI
  ElasticaLaw law_;
};

}  // namespace snare::validation::shooting
