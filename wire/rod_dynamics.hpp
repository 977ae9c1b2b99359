#pragma once

#include "numerics/dae.hpp"
#include "wire/spatial_rod.hpp"

#include <Eigen/Core>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace snare::wire {

/// Material and mass-proportional damping of a wire.                                     theory.md (M.4)
struct RodDamping {
  /// Kelvin-Voigt time of bending: M = EI (kappa + tau dkappa/dt) [s], >= 0. A mode of angular frequency w then has the
  /// damping ratio tau w/2, that is tau = ln(A_0/A_n)/(pi n w) from n periods of a ring-down.
  double bending_time = 0.0;
  double axial_time = 0.0;  ///< of stretching: N = EA (e + tau de/dt) [s], >= 0
  double mass_rate = 0.0;   ///< force -a m v against motion in the world [1/s], >= 0: damping ratio a/(2 w)
};

/// Strands that slide on each other when the wire bends (Papailiou 1997), the slider of (W.13) in both directions of
/// bending, with a dashpot beside its spring:                                                       theory.md (M.14)
///   z' = (m - z)/tau,   m = e for |e| <= slip_curvature, else slip_curvature e/|e|,   e = z + tau kappa'
/// z: curvature that the friction holds [1/m]; the strands add the moment extra_stiffness m to EI kappa. A wire
/// begins with z = 0, as one that has been shaken.
struct RodStrands {
  double extra_stiffness = 0.0;  ///< added to EI while the strands stick [N m^2], >= 0; 0: none
  double slip_curvature = 0.0;   ///< at which a virgin section begins to slip [1/m], > 0
  double time = 1e-5;            ///< tau, short beside the motion [s], > 0
  [[nodiscard]] bool act() const { return extra_stiffness > 0.0; }
};

/// Constants of a wire in motion.
struct RodInMotion {
  SpatialRodProperties properties;  ///< stiffness, mounts, weight
  double mass_per_length = 0.0;     ///< [kg/m], > 0
  double length = 0.0;              ///< unstretched [m], > 0
  int elements = 60;                ///< >= 4
  double grading = 0.0;             ///< of the mesh, see MaterialMesh; 0: equal edges
  RodDamping damping;
  RodStrands strands;
};

/// Tolerances of a wire's unknowns.
struct RodTolerances {
  double position = 1e-7;  ///< [m]
  double velocity = 1e-4;  ///< [m/s]
  double angle = 1e-6;     ///< of twist [rad]
};

/// Where a mount that moves points, and how it turns, at given unknowns of the DAE.
struct MountMotion {
  Frame frame;  ///< direction of increasing arc length and director, in the world
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [rad/s], in the world
};

/// A discrete elastic rod as part of a DAE: vertices x, their velocities v, edge angles theta without inertia.
///                                                                                  theory.md (M.3), (M.4)
///   x' - v = 0,   m v' + dE/dx + dD/dv + a m v = 0,   dE/dtheta + dD/dtheta' = 0
/// With strands two unknowns z a vertex are added, and their moments to the forces (M.14).
/// with lumped masses m and D = sum tau/2 k (d strain/dt)^2. Rigidly held unknowns have x = X, v = 0 instead; the
/// force of the mount is what the row would have left. Without a mount that holds the twist nothing but the damping of
/// bending feels the spin of the whole wire about itself: undamped theta_0 = 0, damped the spin that dissipates least
/// (and a round-off's share of drag that decides for a straight wire).
class RodPart final : public numerics::DaePart {
 public:
  RodPart(std::string name, const RodInMotion& rod, const RodTolerances& tolerances);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;
  /// Carries the reference frames along.
  bool accept(const numerics::DaePoint& at) override;
  void save_state(std::vector<double>& memory) const override;
  void restore_state(const numerics::VectorView& y, std::span<const double>& memory) override;

  /// Puts a start into the unknowns (twist angles zero) and lets the reference frames begin there.
  void place(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& velocities, Eigen::VectorXd& y);

  /// Before `declare`: the mount of one end moves. The vertex there is no longer held by this part: a constraint has to.
  void carry(bool right, std::function<MountMotion(const numerics::VectorView& y)> motion);
  [[nodiscard]] bool is_carried(bool right) const { return static_cast<bool>(carried_[right ? 1 : 0]); }

  /// What the rod does to a mount that moves, and how a turn and a spin of the mount act on the rod. Local unknowns: the
  /// vertex at the mount (3), the next one (3), the angle of the edge between them; rows likewise.  theory.md (M.17)
  struct MountCell {
    Eigen::Vector3d moment;                     ///< of the rod on the mount [N m]
    Eigen::Matrix<double, 3, 7> moment_by;      ///< by the local unknowns' places
    Eigen::Matrix<double, 3, 7> moment_by_rate; ///< by their rates
    Eigen::Matrix3d moment_by_turn, moment_by_spin;  ///< by turn and angular velocity of the mount
    Eigen::Matrix<double, 7, 3> rows_by_turn, rows_by_spin;  ///< of the rod's rows
  };
  [[nodiscard]] MountCell mount_cell(const numerics::DaePoint& at, bool right);
  /// Its moment alone, as of the last `residual` at that point.
  [[nodiscard]] Eigen::Vector3d mount_moment(const numerics::DaePoint& at, bool right);
  /// The angle of the edge beside an end.
  [[nodiscard]] int end_angle(bool right) const { return angle_of(right ? vertices() - 2 : 0); }

  [[nodiscard]] int vertices() const { return rod_.mesh().vertices(); }
  [[nodiscard]] int position_of(int vertex) const { return x_ + 3 * vertex; }  ///< first of three unknowns
  [[nodiscard]] int velocity_of(int vertex) const { return v_ + 3 * vertex; }
  [[nodiscard]] int angle_of(int edge) const { return theta_ + edge; }
  [[nodiscard]] double mass_of(int vertex) const { return mass_[static_cast<std::size_t>(vertex)]; }
  /// Whether component k of a vertex is rigidly held.
  [[nodiscard]] bool is_held(int vertex, int k) const {
    return held_[static_cast<std::size_t>(3 * vertex + k)];
  }
  /// Largest distance of rigidly held components from their mounts [m].
  [[nodiscard]] double mount_error(const numerics::VectorView& y) const;
  [[nodiscard]] double coordinate(int vertex) const { return rod_.mesh().coordinate(vertex, controls_); }
  [[nodiscard]] const SpatialRod& rod() const { return rod_; }
  /// First of the two of z of a vertex; only with strands.
  [[nodiscard]] int strand_of(int vertex) const { return strand_ + 2 * vertex; }
  /// Band index of the rod's own unknown -> unknown of the DAE.
  [[nodiscard]] int unknown_of(int band) const;

  /// Energies [J] at a point; dissipation is a power [W].
  struct Energies {
    double kinetic = 0.0;
    double strain = 0.0;
    double potential = 0.0;
    double dissipation = 0.0;
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();          ///< [kg m/s]
    Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< about the origin [kg m^2/s]
    /// Forces of the left and the right mount that balance the wire's own forces [N].
    std::array<Eigen::Vector3d, 2> mount_forces{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    /// The same as moments about the origin, with the couples of mounts that orient [N m].       theory.md (M.11)
    std::array<Eigen::Vector3d, 2> mount_moments{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    Eigen::Vector3d weight_moment = Eigen::Vector3d::Zero();  ///< of the weight about the origin [N m]
  };
  [[nodiscard]] Energies energies(const numerics::DaePoint& at);
  [[nodiscard]] const RodInMotion& constants() const { return constants_; }

 private:
  struct ViscousCell;
  struct StrandCell;
  void add_strands_jacobian(const ViscousCell& cell, int vertex, const numerics::DaePoint& at, double c,
                            std::vector<double>& values);
  [[nodiscard]] bool bends_with_loss() const {
    return constants_.damping.bending_time > 0.0 || constants_.strands.act();
  }
  struct EndForces;
  [[nodiscard]] EndForces end_forces(const numerics::DaePoint& at, bool right) const;
  void set_mounts(const numerics::VectorView& y, SpatialState& state) const;
  void evaluate(const numerics::DaePoint& at);
  void add_viscous(const numerics::DaePoint& at, Eigen::VectorXd& gradient);
  void add_viscous_jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values);
  void take_unknowns(const numerics::VectorView& y);
  [[nodiscard]] bool holds_angle(int vertex) const {
    return vertex == vertices() - 1 || (holds_first_angle_ && vertex == 0);
  }

  std::string name_;
  RodInMotion constants_;
  RodTolerances tolerances_;
  SpatialRod rod_;
  Controls controls_;
  std::vector<double> mass_;
  std::vector<bool> held_;   // of 3 components a vertex
  bool holds_first_angle_ = false;  // nothing else determines the spin of the wire about itself
  double spin_drag_ = 0.0;          // on the rate of the first angle [N m s]
  int x_ = 0, theta_ = 0, v_ = 0, strand_ = 0;
  SpatialState base_;  // frames of the last accepted state
  SpatialState trial_;
  RodAssembly assembly_;
  Eigen::VectorXd band_;
  double viscous_power_ = 0.0;
  std::array<Eigen::Vector3d, 2> viscous_couples_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // of the mounts
  double strand_energy_ = 0.0;
  std::vector<Eigen::Vector2d> strand_rates_;  // z' by the last evaluation [1/(m s)]
  const numerics::SparseMatrix* pattern_ = nullptr;
  std::array<std::function<MountMotion(const numerics::VectorView& y)>, 2> carried_;
  std::vector<int> band_slots_;  // of the lower band in the rows of v and theta, both triangles
  std::vector<int> rate_slots_;  // the same in the columns of v
  std::vector<int> diagonal_;    // of x, v: (x,x) (x,v) (v,v)
};

}  // namespace snare::wire
