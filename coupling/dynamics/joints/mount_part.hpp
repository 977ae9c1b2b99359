#pragma once

#include "coupling/dynamics/joints/constraint.hpp"
#include "coupling/dynamics/model/arm.hpp"
#include "wire/motion/rod_part.hpp"

#include <vector>

namespace snare::coupling {

/// One end of a wire held by a frame that moves, or that gives along its axis.       theory.md (M.17), (M.38)
///
///   B^T r = 0,  B^T w = 0,  r = x - p_WM,  w = v - v_M - omega x r
/// x, v: the end vertex; M: the mount's frame, its x axis a the direction of increasing arc length, its y
/// axis the director. A rigid mount holds all three axes; of one that gives, B has the two across a, and
/// along it acts
///   s = -k (u - z) - c u',  u = a.r,  u' = a.w
/// where z' is the slip of the spring beyond its largest force. The force f = B l + s a on the vertex has the
/// multiplier l, stabilised by another one in x' = v + B mu; the carrier gets -f at x, and the moment of the
/// half cell beside the mount. The wire is discretised as between mounts that stand still.
class MountPart final : public Constraint {
 public:
  /// Lets the end of the rod be carried: before the rod declares its unknowns.
  MountPart(const MotionMount& mount, MovingFrame frame, wire::RodPart& rod, const MotionOptions& options);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  /// After the rod's own.
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;

  /// Gives the end the mount's velocity, in what it holds. Unknowns y in SI units.
  void place(Eigen::VectorXd& y) const;

  [[nodiscard]] int constraints() const override { return give_.gives() ? 2 : 3; }
  [[nodiscard]] Eigen::VectorXd velocity_error(const numerics::VectorView& y,
                                               const Eigen::VectorXd& dv) const override;
  /// Constraint: what B^T w changes by along the rates of the coordinates while the velocities stay [m/s^2].
  [[nodiscard]] Eigen::VectorXd acceleration_bias(const numerics::VectorView& y,
                                                  const Eigen::VectorXd& rate) const override;
  /// Constraint: B l/m of the end vertex, m its inertia, and what the opposite does to a carrier that moves
  /// freely.
  void apply_impulse(const numerics::VectorView& y, const Eigen::VectorXd& multipliers,
                     Eigen::VectorXd& dv) const override;
  /// Force f on the wire's end, and its moment r x f about the mount; the half cell's is `moment`.
  [[nodiscard]] multibody::Wrench wrench(const numerics::VectorView& y) const override;
  /// Of the wire on the mount, at the point of the rod's last evaluation [N m].
  [[nodiscard]] Eigen::Vector3d moment(const numerics::DaePoint& at) const {
    return rod_.mount_moment(at, end_);
  }
  [[nodiscard]] const wire::RodPart& rod() const { return rod_; }
  [[nodiscard]] wire::End end() const { return end_; }
  /// Of the spring [J], and what spring and dashpot lose [W], >= 0; y in SI units.
  [[nodiscard]] double spring_energy(const numerics::VectorView& y) const;
  [[nodiscard]] double lost_power(const numerics::VectorView& y) const;
  /// Distance of the end from its mount, across the axis where it gives [m].
  [[nodiscard]] double gap(const numerics::VectorView& y) const override;

 private:
  using Axes = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;
  /// The mount at one point, in the axes of the world.
  struct Hold {
    Axes axes;              ///< B
    Eigen::Vector3d along;  ///< a
    Eigen::Vector3d r, w;
    Eigen::Vector3d omega;  ///< of the mount
    double strain = 0.0;    ///< u - z
    double rate = 0.0;      ///< u'
    double spring = 0.0;    ///< s
    Eigen::Vector3d force;  ///< f
  };
  [[nodiscard]] Hold hold(const numerics::VectorView& y) const;
  /// z' [m/s] of a strain u - z [m], and its derivative by it.
  struct Slip {
    double rate = 0.0, by_strain = 0.0;
  };
  [[nodiscard]] Slip slip(double strain) const;
  /// What moves when an unknown does: the end, the mount's place, and the velocities of both. A turn leaves a
  /// rigid mount's axes.
  struct Change {
    Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();
    Eigen::Vector3d spin = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d end_shift = Eigen::Vector3d::Zero(), end_velocity = Eigen::Vector3d::Zero();
  };
  /// Adds what follows from it, of what gives: rows of the constraint, of the end and of z. Returns the
  /// wrench's change on the carrier.
  multibody::Wrench add_change(const Hold& h, const numerics::VectorView& y, int column, const Change& change,
                               const numerics::PatternValues& into) const;
  void add_rigid(const numerics::PatternValues& into) const;
  [[nodiscard]] std::vector<std::pair<int, multibody::Wrench>> add_own_changes(
      const Hold& h, const numerics::VectorView& y, double c, const numerics::PatternValues& into) const;
  void append_sparsity_of_give(std::vector<std::pair<int, int>>& entries) const;

  /// Unknowns of the half cell (wire::MountCell): vertex at the mount, next vertex, angle of the edge
  /// between; and the rows of their balances, which for the vertices are the unknowns v too.
  [[nodiscard]] std::vector<int> places() const;
  [[nodiscard]] std::vector<int> balances() const;
  void append_curvatures(std::vector<int>& list) const;
  [[nodiscard]] int vertex() const { return rod_.model().vertex_at(end_); }
  [[nodiscard]] int position() const { return rod_.position_of(vertex()); }
  [[nodiscard]] int speed() const { return rod_.velocity_of(vertex()); }

  // First of the multipliers each, and of the rows of the same index: place and velocity of the end.
  [[nodiscard]] int force() const { return multipliers(); }
  [[nodiscard]] int stabiliser() const { return stabiliser_; }

  wire::RodPart& rod_;
  wire::End end_;
  MountGive give_;
  int stabiliser_ = 0;
  int slip_ = -1;  // the unknown z; -1: it never slips
};

}  // namespace snare::coupling
