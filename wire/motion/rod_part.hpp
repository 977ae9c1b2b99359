#pragma once

#include "numerics/dae.hpp"
#include "wire/end.hpp"
#include "wire/motion/bending_cell.hpp"
#include "wire/motion/mount_cell.hpp"
#include "wire/motion/rod_forces.hpp"
#include "wire/motion/rod_in_motion.hpp"
#include "wire/motion/rod_model.hpp"
#include "wire/motion/rod_plane.hpp"
#include "wire/motion/rod_slots.hpp"
#include "wire/motion/rod_stiffness.hpp"
#include "wire/spatial_rod.hpp"

#include <Eigen/Core>

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace snare::wire {

/// A discrete elastic rod as part of a DAE: vertices x, their velocities v, edge angles theta without
/// inertia, of higher order curvatures k as well.
///                                                                                     theory.md (M.3), (M.4)
///   x' - v = 0,   m v' + dE/dx + dD/dv + a m v = 0,   dE/dtheta + dD/dtheta' = 0,   dE/dk = 0
///
/// with lumped masses m and D = sum tau/2 k (d strain/dt)^2. With strands two unknowns z a vertex are added,
/// and their moments to the forces (M.14). Rigidly held unknowns have x = X, v = 0 instead; the force of the
/// mount is what the row would have left. Without a mount that holds the twist nothing but the damping of
/// bending feels the spin of the whole wire about itself: undamped theta_0 = 0, damped the spin that
/// dissipates least (and a round-off's share of drag that decides for a straight wire).
class RodPart final : public numerics::DaePart {
 public:
  RodPart(std::string name, const RodInMotion& rod, const RodTolerances& tolerances);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override {
    append_sparsity(model_, entries);
  }
  void rates(std::vector<std::pair<int, int>>& pairs) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;
  /// Carries the reference frames along.
  void accept(const numerics::DaePoint& at) override;
  void save_state(std::vector<double>& memory) const override;
  void restore_state(const numerics::VectorView& y, std::span<const double>& memory) override;

  /// What its places, speeds and angles may err by.
  [[nodiscard]] const RodTolerances& tolerances() const { return tolerances_; }

  /// Puts a start, (3, vertices) [m] and [m/s], into the unknowns (twist angles zero) and lets the reference
  /// frames begin there.
  void place(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& velocities, Eigen::VectorXd& y);

  /// The plane across axis `normal` of the world (0 to 2) in which the rod stays, since at its start it is
  /// its own mirror image there, to round-off:
  /// its places, mounts, frames, weight and what it is by nature. None where it is not.      theory.md (M.36)
  [[nodiscard]] std::optional<RodPlane> plane_across(int normal) const;
  /// Works out from here on only what happens in a plane, in which it has to be. Returns the unknowns that
  /// leave the plane, or turn out of it, which have to be held.
  [[nodiscard]] std::vector<int> restrict_to_plane(const RodPlane& plane);
  /// What happens in space is computed again.
  void leave_plane();

  /// Before `declare`: the mount of one end moves, as it does at unknowns y (SI units). The vertex there is
  /// no longer held by this part: a constraint has to.
  void carry(End end, std::function<MountMotion(const numerics::VectorView& y)> motion);
  [[nodiscard]] bool is_carried(End end) const { return static_cast<bool>(carried_[index_of(end)]); }
  /// The half cell at a mount that moves.
  [[nodiscard]] MountCell mount_cell(const numerics::DaePoint& at, End end);
  /// Its moment alone [N m], as of the last `residual` at that point.
  [[nodiscard]] Eigen::Vector3d mount_moment(const numerics::DaePoint& at, End end);

  /// The rod's constants, masses and places among the unknowns; what it was made from; its elastic forces.
  [[nodiscard]] const RodModel& model() const { return model_; }
  [[nodiscard]] const RodInMotion& constants() const { return model_.constants(); }
  [[nodiscard]] const SpatialRod& rod() const { return model_.rod(); }
  [[nodiscard]] int vertices() const { return model_.vertices(); }
  /// Vertices there are, and first unknown of a vertex's place, of its velocity, and unknown of an edge's
  /// angle: see RodModel.
  [[nodiscard]] int position_of(int vertex) const { return model_.position_of(vertex); }
  [[nodiscard]] int velocity_of(int vertex) const { return model_.velocity_of(vertex); }
  [[nodiscard]] int angle_of(int edge) const { return model_.angle_of(edge); }
  /// The angle of the edge beside an end.
  [[nodiscard]] int end_angle(End end) const { return model_.angle_of(model_.edge_at(end)); }
  /// First of the two of z of a vertex; only with strands.
  [[nodiscard]] int strand_of(int vertex) const { return model_.strand_of(vertex); }
  /// Lumped mass of a vertex [kg].
  [[nodiscard]] double mass_of(int vertex) const { return model_.mass_of(vertex); }
  [[nodiscard]] bool is_held(int vertex, int k) const { return model_.is_held(vertex, k); }
  /// Material coordinate of a vertex, from the left mount [m].
  [[nodiscard]] double coordinate(int vertex) const {
    return rod().mesh().coordinate(vertex, model_.controls());
  }
  /// Largest distance of rigidly held components from their mounts [m].
  [[nodiscard]] double mount_error(const numerics::VectorView& y) const;

  /// Energies [J] at a point; dissipation is a power [W].
  struct Energies {
    double kinetic = 0.0;
    double strain = 0.0;
    double potential = 0.0;
    double dissipation = 0.0;
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();          ///< [kg m/s]
    Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< about the origin [kg m^2/s]
    Eigen::Vector3d drag = Eigen::Vector3d::Zero();              ///< of `mass_rate`, against the motion [N]
    Eigen::Vector3d drag_moment = Eigen::Vector3d::Zero();       ///< about the origin [N m]
    /// Forces of the left and the right mount that balance the wire's own forces [N].
    std::array<Eigen::Vector3d, 2> mount_forces{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    /// The same as moments about the origin, with the couples of mounts that orient [N m].   theory.md (M.11)
    std::array<Eigen::Vector3d, 2> mount_moments{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    Eigen::Vector3d weight_moment = Eigen::Vector3d::Zero();  ///< of the weight about the origin [N m]
  };
  [[nodiscard]] Energies energies(const numerics::DaePoint& at);

  /// What its section bears at a point.
  struct SectionLoads {
    Eigen::VectorXd tensions;         ///< of the edges, with their damping [N]
    Eigen::VectorXd bending_moments;  ///< of the vertices, without damping and strands, >= 0 [N m]
  };
  [[nodiscard]] SectionLoads section_loads(const numerics::DaePoint& at);

  /// What a quasi-static wire would have more, were all its mass counted.                    theory.md (M.18)
  struct LeftOut {
    double kinetic = 0.0;                                ///< [J]
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  ///< [kg m/s]
  };
  /// At unknowns y of the run (SI units).
  [[nodiscard]] LeftOut left_out(const numerics::VectorView& y) const;

 private:
  void work_in(const std::optional<RodPlane>& plane);
  void evaluate(const numerics::DaePoint& at);
  void begin_from_accepted();
  void add_losses_jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values);
  void set_mounts(const numerics::VectorView& y, RodInstant& instant) const;
  void take_unknowns(const numerics::VectorView& y);
  /// Whether `trial_` and what belongs to it are those of a point.
  [[nodiscard]] bool is_evaluated(const numerics::DaePoint& at) const;

  std::string name_;
  RodTolerances tolerances_;
  RodModel model_;
  std::array<std::function<MountMotion(const numerics::VectorView& y)>, 2> carried_;
  RodSlots slots_;

  RodInstant accepted_;  // the state: frames of the last accepted step

  // Workspace: the point of the last evaluation.
  RodInstant trial_;
  Eigen::VectorXd y_, rate_;       // that point, empty: none
  RodAssembly assembly_;           // energy and forces
  Eigen::Matrix2Xd by_curvature_;  // dE/dk of higher order
  RodLosses losses_;
  RodForces forces_;
  RodStiffness stiffness_;
  Eigen::VectorXd band_;
};

}  // namespace snare::wire
