#pragma once

#include "coupling/contact/curve.hpp"
#include "coupling/dynamics/contact_geometry.hpp"
#include "coupling/dynamics/options.hpp"
#include "coupling/dynamics/result.hpp"

#include <array>
#include <optional>
#include <vector>

namespace snare::coupling {

/// One point of contact between a wire and a body's shape: material coordinate zeta, normal force lambda, and the
/// multiplier mu that stabilises the constraint (Gear, Gupta, Leimkuhler 1985).            theory.md (M.7)-(M.9)
///
///   closed:  n.X'(zeta) = 0,  g = 0,  dg/dt = 0;   x_k' = v_k + N_k n mu/m_k
///   open:    zeta = where it was, lambda = 0, mu = 0
/// Where the gap has no proper minimum (an end of the wire, a wire that follows the surface) zeta stays on its material
/// point (G.9).
/// A bristle adds its deflection z in the tangent plane's axes a = X'/|X'| and b = n x a, which go with wire and body:
///   closed:  dz/dt = (f/k - z)/tau, friction f of tangent_force;    open:  z = 0
/// With a law instead of the constraint lambda = law(-g, -dg/dt) while closed.
class ContactPart final : public numerics::DaePart {
 public:
  ContactPart(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body,
              const MotionOptions& options);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;
  [[nodiscard]] int event_count() const override { return 1; }
  /// Closed: the normal force (constraint), the penetration (law). Open: nothing happens, see ContactSearch.
  void events(const numerics::DaePoint& at, std::span<double> values) override;
  /// The window of vertices that the pattern covers follows the contact.
  bool accept(const numerics::DaePoint& at) override;

  [[nodiscard]] bool closed() const { return closed_; }
  [[nodiscard]] bool has_law() const { return static_cast<bool>(contact_.law); }
  /// Whether zeta stays on its material point.
  [[nodiscard]] bool is_fixed_to_wire() const { return fixed_; }
  /// Where an open contact keeps its material coordinate.
  void wait_at(double coordinate, Eigen::VectorXd& y) { y[coordinate_unknown()] = kept_coordinate_ = coordinate; }
  /// The normal force with which the integration begins anew; it may pull by the forces' tolerance, and lifts off when
  /// it pulls by as much more.
  void begin_force(double force, Eigen::VectorXd& y);
  /// Keeps a closed point on its material point until the minimum comes back.
  void rest_on_wire();
  /// Closes at a material coordinate and sets the contact's own unknowns. True: the pattern changes.
  [[nodiscard]] bool close(double coordinate, Eigen::VectorXd& y);
  /// Of a wire that lies flat at a material coordinate: that of a vertex beside it which lies there as well.
  [[nodiscard]] std::optional<double> level_vertex(double coordinate, Eigen::VectorXd y) const;
  /// Returns the energy that the bristle still held and that is lost [J].
  [[nodiscard]] double open(Eigen::VectorXd& y);
  /// Of a closed point.
  [[nodiscard]] ContactSample sample(const numerics::DaePoint& at) const;
  [[nodiscard]] double gap(const numerics::VectorView& y) const;
  /// Relative normal speed dg/dt [m/s].
  [[nodiscard]] double gap_rate(const numerics::VectorView& y) const;
  /// Power lost to friction (and taken by a law) [W].
  [[nodiscard]] double lost_power(const numerics::VectorView& y) const;

  void save_state(std::vector<double>& memory) const override;
  void restore_state(const numerics::VectorView& y, std::span<const double>& memory) override;
  [[nodiscard]] bool has_bristle() const { return contact_.friction.has_bristle(); }
  /// Stick or slip of a closed contact with a bristle. With the unknowns it is all that the friction remembers.
  [[nodiscard]] FrictionMode friction_mode() const { return mode_; }
  void set_friction_mode(FrictionMode mode) { mode_ = mode; }
  /// What keeps the mode [N]: see coupling::friction_margin. One newton where nothing can switch.
  [[nodiscard]] double friction_margin(const numerics::VectorView& y) const;
  [[nodiscard]] double sliding_speed(const numerics::VectorView& y) const;
  /// Energy of the bristle, k |z|^2/2 [J].
  [[nodiscard]] double bristle_energy(const numerics::VectorView& y) const;
  /// dz/dt into `rate`.
  void set_bristle_rate(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const;
  /// Accelerations by a normal force and the friction that is proportional to it, added to `rate`.
  void respond_with_friction(const numerics::VectorView& y, double force, Eigen::VectorXd& rate) const;

  /// What of the contact force falls on rigidly held components of the first and the last vertex [N].
  [[nodiscard]] std::array<Eigen::Vector3d, 2> force_on_mounts(const numerics::VectorView& y) const;
  /// The same of any force (or impulse) on the wire at the contact.
  [[nodiscard]] std::array<Eigen::Vector3d, 2> share_of_mounts(const numerics::VectorView& y,
                                                               const Eigen::Vector3d& force) const;
  /// From the body to the wire, unit, in the world frame.
  [[nodiscard]] Eigen::Vector3d normal(const numerics::VectorView& y) const;

  /// The unknowns zeta, lambda and mu, and the rows that determine them.
  [[nodiscard]] int coordinate_unknown() const { return coordinate_; }
  [[nodiscard]] int force_unknown() const { return coordinate_ + 1; }
  [[nodiscard]] int stabiliser_unknown() const { return coordinate_ + 2; }
  /// First of the two of z; only with a bristle.
  [[nodiscard]] int bristle_unknown() const { return coordinate_ + 3; }

  /// Velocity changes of an impulse at the contact [N s], added to dv.
  void apply_impulse(const numerics::VectorView& y, double impulse, Eigen::VectorXd& dv) const;
  /// Rate of dg/dt along velocities and quaternion rates with all accelerations zero [m/s^2].
  [[nodiscard]] double gap_acceleration_at_rest(const numerics::VectorView& y) const;
  /// d(dg/dt) for changes of velocities alone.
  [[nodiscard]] double gap_rate_of(const numerics::VectorView& y, const Eigen::VectorXd& velocities) const;

 private:
  /// Vertices in the pattern, more than the four of the curve so that it seldom changes.
  static constexpr int window_size = 10;
  struct Geometry : ContactGeometry {
    CurveWeights weights;
  };
  [[nodiscard]] Geometry geometry(const numerics::VectorView& y) const;
  /// At the unknown coordinate, on the wire.
  [[nodiscard]] CurveWeights weights(const numerics::VectorView& y) const;
  [[nodiscard]] bool follow(const numerics::VectorView& y);
  /// d2 gap/d zeta2 [1/m].
  [[nodiscard]] double gap_curvature(const Geometry& g) const;
  [[nodiscard]] bool is_at_an_end(double coordinate) const;
  [[nodiscard]] std::vector<int> local_unknowns(int first_vertex) const;
  [[nodiscard]] std::vector<int> own_unknowns() const;
  void respond_along(const Geometry& g, const Eigen::Vector3d& impulse, Eigen::VectorXd& dv) const;

  MotionContact contact_;
  const wire::RodPart& rod_;
  const BodyPart& body_;
  MotionOptions options_;
  bool closed_ = false;
  FrictionMode mode_ = FrictionMode::stick;
  double least_force_ = 0.0;  // at which it lifts off, <= 0 [N]
  double kept_coordinate_ = 0.0;
  bool fixed_ = false;        // zeta to its material point
  double fixed_slope_ = 0.0;  // n.X' there at the last accepted state
  bool coupled_ = false;      // has been closed, and is in the pattern
  int window_ = 0;            // first vertex that the pattern covers
  int coordinate_ = 0;        // first of the own unknowns
  const numerics::SparseMatrix* pattern_ = nullptr;
};

/// The event at which a contact changes between stick and slip. It owns no unknowns; a part of its own, so that the
/// contacts' events keep one place each.
class FrictionEvent final : public numerics::DaePart {
 public:
  explicit FrictionEvent(const ContactPart& contact) : contact_(contact) {}
  void declare(numerics::DaeLayout& /*layout*/) override {}
  void sparsity(std::vector<std::pair<int, int>>& /*entries*/) const override {}
  void attach_pattern(const numerics::SparseMatrix& /*pattern*/) override {}
  void residual(const numerics::DaePoint& /*at*/, Eigen::Ref<Eigen::VectorXd> /*rows*/) override {}
  void jacobian(const numerics::DaePoint& /*at*/, double /*c*/, std::vector<double>& /*values*/) override {}
  [[nodiscard]] int event_count() const override { return 1; }
  void events(const numerics::DaePoint& at, std::span<double> values) override {
    values[0] = contact_.friction_margin(at.y);
  }

 private:
  const ContactPart& contact_;
};

}  // namespace snare::coupling
