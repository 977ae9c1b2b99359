#pragma once

#include "coupling/dynamics/contact/bristle_means.hpp"
#include "coupling/dynamics/contact/contact_geometry.hpp"
#include "coupling/dynamics/contact/contact_intervals.hpp"
#include "coupling/dynamics/contact/contact_search.hpp"
#include "coupling/dynamics/model/options.hpp"
#include "coupling/dynamics/model/press.hpp"
#include "coupling/dynamics/model/result.hpp"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace snare::coupling {

/// Contact between a wire and one convex piece of a body's shape.                       theory.md (M.7)-(M.9)
///
///   f(S) = lambda n - friction, a length of the wire, where the gap is negative;  nodal forces  int N_k f dS
/// by Gauss's rule on every stretch that is closed, so that the force is continuous whatever touches, slides
/// on, wraps or lets go. With a law of fast simulators the force of each local minimum of the gap acts there
/// instead. Friction with bristles adds their deflection z_i at every vertex, in the axes along the wire and
/// across it. Each carries friction in the share of its hat H_i and moves by a mean over the load: see
/// BristleMeans.
class ContactPart final : public numerics::DaePart {
 public:
  ContactPart(const MotionContact& contact, std::shared_ptr<const ContactShape> piece,
              const wire::RodPart& rod, const BodyPart& body);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;
  /// Where an element touches that is not in the pattern: those that touch come in, with some neighbours, and
  /// those that are no longer near go out.
  bool outgrows_pattern(const numerics::DaePoint& at) override;
  /// The elements that may be touched next.
  void accept(const numerics::DaePoint& at) override;
  [[nodiscard]] numerics::IterationStart iteration_start(const numerics::VectorView& from,
                                                         const numerics::VectorView& to) override;
  void restore_state(const numerics::VectorView& y, std::span<const double>& memory) override;
  /// The same as `accept` at a start, unknowns y in SI units.
  void update_candidates(const numerics::VectorView& y) {
    search_.update(y);
    found_.inputs.forget();
  }

  /// Which elements are near, and where the wire's curve is.
  [[nodiscard]] const ContactSearch& search() const { return search_; }
  /// Whether a law of fast simulators acts, at every local minimum, in place of the foundation.
  [[nodiscard]] bool has_law() const { return static_cast<bool>(contact_.law); }
  /// Whether friction has bristles, two unknowns a vertex: see bristle_of.
  [[nodiscard]] bool has_bristle() const { return contact_.friction.has_bristle(); }
  /// First of the two of a vertex; only with bristles.
  [[nodiscard]] int bristle_of(int vertex) const { return bristle_ + 2 * vertex; }

  /// Works out derivatives from here on only within a plane across axis `normal` of the world (0 to 2), in
  /// which wire and body stay. Returns the unknowns that leave it, the bristles' deflections across the wire:
  /// see RodPart.
  [[nodiscard]] std::vector<int> restrict_to_plane(int normal);
  /// What happens in space is computed again.
  void leave_plane() { normal_.reset(); }

  /// What the contact does in all, for balances.
  struct Sums {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< on the wire [N]
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< of it about the origin [N m]
    double normal = 0.0;                               ///< sum of the normal forces [N]
    double lost_power = 0.0;                           ///< to friction and damping [W], >= 0
    double energy = 0.0;                               ///< of the foundation, or laws, and of bristles [J]
    double body_power = 0.0;                           ///< done on the wire by the body as it moves [W]
    /// What of it falls on rigidly held components of the first and the last vertex [N].
    std::array<Eigen::Vector3d, 2> on_mounts{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  };
  /// At unknowns y of the run (SI units).
  [[nodiscard]] Sums sums(const numerics::VectorView& y) const;
  /// Gap [m] and its rate [m/s] at a material coordinate [m].
  [[nodiscard]] std::pair<double, double> gap_at(const numerics::VectorView& y, double coordinate) const;
  /// dz/dt [m/s] of the bristles into their places of `rate`, at unknowns y in SI units.
  void set_bristle_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const;
  /// One sample for every stretch along the wire that is closed, in their order. y in SI units.
  [[nodiscard]] std::vector<ContactSample> samples(const numerics::VectorView& y) const;

 private:
  /// A place where the force is taken, with its weight in the integral.
  struct QuadraturePoint {
    int element = 0;
    double u = 0.0;
    double weight = 0.0;  // [m]; with a law 1, of a force
    int first = 0;        // of the four vertices
    Eigen::Vector4d value, slope, bend;
    std::array<double, 2> shape_functions{};  // of the element's vertices
    bool follows = false;                     // the minimum as it moves along the wire: a law's
    ContactPlace place = ContactPlace::wire;
    std::size_t stretch = 0;
  };
  struct ContactCache {
    InputMemo inputs;
    std::vector<QuadraturePoint> nodes;
    std::vector<ContactInterval> stretches;  // of single elements
    std::vector<int> elements;               // of each stretch
    std::vector<GapPlace> minima;
    std::vector<ContactGeometry> geometries;  // of the nodes
    BristleMeans bristles;
  };
  const ContactCache& found_at(const numerics::VectorView& y) const;
  void find(const numerics::VectorView& y, ContactCache& found) const;
  void add_up_bristles(const numerics::VectorView& y, ContactCache& found) const;
  /// State of the bristle of one of the element's two vertices at a node, and its flow there.
  [[nodiscard]] BristleState bristle_state(const QuadraturePoint& node, std::size_t h,
                                           const ContactGeometry& g, const numerics::VectorView& y) const;
  [[nodiscard]] BristleFlow bristle_flow_at(const QuadraturePoint& node, std::size_t h,
                                            const ContactGeometry& g, const numerics::VectorView& y) const;
  void add_stretch(int element, const ContactInterval& stretch, std::size_t index,
                   std::vector<QuadraturePoint>& nodes) const;
  [[nodiscard]] bool stops(wire::End end) const;
  [[nodiscard]] double foundation_share(double coordinate) const;
  [[nodiscard]] QuadraturePoint node(int element, double u, double weight) const;
  [[nodiscard]] ContactGeometry geometry(const QuadraturePoint& node, const numerics::VectorView& y) const;
  /// Whether anything moves along an axis of the world, or turns about it.
  [[nodiscard]] bool moves_along(int axis) const { return normal_ != axis; }
  [[nodiscard]] bool turns_about(int axis) const { return normal_.value_or(axis) == axis; }
  // Rows and columns of what an element's nodes are in the Jacobian: balances of its four vertices, of the
  // body, rows of its two bristles; by places and velocities of the vertices, by those of the body, by the
  // bristles.
  static constexpr int body_rows = 12, bristle_rows = 18;
  static constexpr int velocity_columns = 12, body_columns = 24,
                       body_rate_columns = body_columns + BodyPart::coordinates,
                       bristle_columns = body_rate_columns + BodyPart::velocities;
  using DerivativeRows = Eigen::Matrix<double, bristle_rows + 4, 1>;
  void add_node_derivatives(const QuadraturePoint& node, const ContactGeometry& geometry,
                            const BristleMeans& means, const numerics::VectorView& y);
  /// What the bristles feel of the ends of a closed stretch, where p_e vanishes but not its rate.
  void add_end_derivatives(int element, double u, const BristleMeans& means, const numerics::VectorView& y);
  void put_derivatives(int element, const numerics::PatternValues& into) const;

  MotionContact contact_;
  double mount_length_ = 0.0;  // of the piece of the wire that gives way at a mount [m]
  MotionContact at_mount_;     // how a mount itself meets the body
  double mount_weight_ = 0.0;  // [m]
  const wire::RodPart& rod_;
  const BodyPart& body_;
  ContactSearch search_;
  std::vector<bool> coupled_;  // elements in the pattern
  std::optional<int> normal_;  // of the plane in which everything stays
  int bristle_ = 0;
  numerics::PatternSlots slots_;
  AcceptedPress accepted_;
  mutable ContactCache found_;  // of the last place that was asked for
  Eigen::Matrix<double, bristle_rows + 4, bristle_columns + 4> derivatives_;  // workspace
};

}  // namespace snare::coupling
