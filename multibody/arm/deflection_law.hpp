#pragma once

#include <vector>

namespace snare::multibody {

/// One piece of a joint's law, from a size of the deflection on.
struct DeflectionPiece {
  double from = 0.0;           ///< |deflection| at which it begins [rad], the first 0, increasing
  double stiffness = 0.0;      ///< slope of the torque [N m/rad]; given: >= 0
  double damping = 0.0;        ///< at its beginning [N m s/rad], >= 0
  double damping_slope = 0.0;  ///< by |deflection| [N m s/rad^2]; of the ramps that the law puts in, else 0
};

/// How a table of stiffnesses against the deflection is read.
enum class StiffnessReading {
  continuous,  ///< the stiffness is the slope: the torque is continuous
  literal      ///< torque = stiffness times deflection: the torque jumps between the pieces
};

/// Which rate the damping acts on.
enum class DampingRate {
  deflection,  ///< q' - qm': a loss inside the gear
  motor        ///< qm': a loss of the motor, as Spong's D stands in the equations
};

/// Torque of an elastic joint as an odd, piecewise linear function of the deflection q - qm.
///                                                                                           theory.md (A.10)
///
///   continuous: T = sgn(d) (T_i + k_i (|d| - a_i)),   T_i the torque at the beginning a_i of the piece
///   literal:    T = k_i d
/// Both come from a continuous energy. One piece is a linear joint; a first piece without stiffness is
/// backlash. With a width of the jumps, torque and damping go linearly from a_i - width/2 to a_i + width/2
/// where either would
/// jump: both are then continuous, and a load between the torques on the two sides finds its place inside.
/// A branch is a piece with the sign of the deflection, -n..n; branch 0 is the piece around zero. The
/// functions of a branch are smooth and go on beyond its ends, so that an integrator can find where it is
/// left.
class DeflectionLaw {
 public:
  /// At least one piece, from 0 on, increasing. jump_width [rad], >= 0 and less than any piece; 0: jumps stay
  /// jumps.
  /// Throws std::invalid_argument.
  explicit DeflectionLaw(std::vector<DeflectionPiece> pieces,
                         StiffnessReading reading = StiffnessReading::continuous,
                         DampingRate damping_rate = DampingRate::deflection, double jump_width = 0.0);
  /// One piece: stiffness [N m/rad], >= 0; damping [N m s/rad], >= 0.
  [[nodiscard]] static DeflectionLaw linear(double stiffness, double damping);

  /// The branch, -n ... n, that holds a deflection [rad]; at a jump the outer one.
  [[nodiscard]] int branch_of(double deflection) const;
  [[nodiscard]] double lower_end(int branch) const;  ///< [rad]; -infinity for the outermost
  [[nodiscard]] double upper_end(int branch) const;
  [[nodiscard]] bool outermost(int branch) const;

  /// Elastic torque on the motor, against the link [N m].
  [[nodiscard]] double torque(int branch, double deflection) const;
  [[nodiscard]] double stiffness(int branch) const;
  [[nodiscard]] double damping(int branch, double deflection) const;  ///< [N m s/rad]
  /// d damping / d deflection [N m s/rad^2]
  [[nodiscard]] double damping_slope(int branch, double deflection) const;
  /// Stored, zero without deflection [J].
  [[nodiscard]] double energy(int branch, double deflection) const;

  /// With the ramps that the width of the jumps puts between those that were given.
  [[nodiscard]] const std::vector<DeflectionPiece>& pieces() const { return pieces_; }
  [[nodiscard]] DampingRate damping_rate() const { return damping_rate_; }

 private:
  [[nodiscard]] const DeflectionPiece& piece(int branch) const;
  void add_ramps(double width);

  std::vector<DeflectionPiece> pieces_;
  std::vector<double> torque_from_;  // torque at the beginning of a piece, continued into it [N m]
  std::vector<double> energy_from_;  // energy there [J]
  DampingRate damping_rate_;
};

}  // namespace snare::multibody
