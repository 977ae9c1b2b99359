#pragma once

#include "coupling/dynamics/contact/bristle_means.hpp"
#include "coupling/dynamics/contact/contact_intervals.hpp"
#include "coupling/dynamics/contact/contact_touches.hpp"
#include "coupling/dynamics/contact/interaction.hpp"
#include "coupling/dynamics/contact/wire_pair_geometry.hpp"
#include "coupling/dynamics/contact/wire_pair_search.hpp"
#include "coupling/dynamics/model/press.hpp"
#include "coupling/dynamics/model/result.hpp"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace snare::coupling {

/// Contact of two wires with each other.                                             theory.md (M.20), (M.21)
///
/// Half of the foundation's load is integrated along the first wire against the nearest points of the second,
/// half along the second against those of the first:
///   E = 1/2 int e(g(S_1)) dS_1 + 1/2 int e(g(S_2)) dS_2,   e(g) = k g^2/2
/// by Gauss's rule on every closed stretch of an element. Wires that cross meet Hertz's form of law, wires
/// that lie along each other k d a length, and between these nothing is told apart. Friction with bristles
/// adds deflections at the vertices of both wires: see ContactPart.
class WirePairPart final : public numerics::DaePart, public Interaction {
 public:
  WirePairPart(const WirePair& pair, const wire::RodPart& first, const wire::RodPart& second);

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;
  /// Where elements touch that are not in the pattern: see ContactPart.
  bool outgrows_pattern(const numerics::DaePoint& at) override;
  /// The elements that may touch next.
  void accept(const numerics::DaePoint& at) override;
  [[nodiscard]] numerics::IterationStart iteration_start(const numerics::VectorView& from,
                                                         const numerics::VectorView& to) override;
  void save_state(std::vector<double>& memory) const override { touches_.save_state(memory); }
  void restore_state(const numerics::VectorView& y, std::span<const double>& memory) override;
  /// The same as `accept` at a start, unknowns y in SI units.
  void update_candidates(const numerics::VectorView& y) override {
    search_.update(y);
    found_.inputs.forget();
  }

  /// Which elements of the two are near each other.
  [[nodiscard]] const WirePairSearch& search() const { return search_; }
  /// Whether friction has bristles, two unknowns a vertex of either wire: see bristle_of.
  [[nodiscard]] bool has_bristle() const { return pair_.friction.has_bristle(); }

  /// First of the two of a vertex of the first or the second wire; only with bristles.
  [[nodiscard]] int bristle_of(std::size_t wire, int vertex) const { return bristles_[wire] + 2 * vertex; }

  /// What the contact does in all, for balances.
  struct Sums {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on the first wire [N]
    double normal = 0.0;                              ///< sum of the normal forces [N]
    double lost_power = 0.0;                          ///< to friction and damping [W], >= 0
    double energy = 0.0;                              ///< of the foundation and of bristles [J]
    /// Of friction about the wires' own axes, taken as held: on the wires it would be, and is not [N m].
    Eigen::Vector3d held_moment = Eigen::Vector3d::Zero();
    /// What of it falls on rigidly held components of the first and the last vertex, of both wires [N].
    std::array<std::array<Eigen::Vector3d, 2>, 2> on_mounts;
  };
  /// At unknowns y of the run (SI units).
  [[nodiscard]] Sums sums(const numerics::VectorView& y) const;
  /// dz/dt [m/s] of the bristles into their places of `rate`, at unknowns y in SI units.
  void set_bristle_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const override;

  void append(std::vector<numerics::DaePart*>& parts) override { parts.push_back(this); }
  [[nodiscard]] std::optional<base::InputProblem> overlap(const numerics::VectorView& y,
                                                          double tolerance) const override;
  [[nodiscard]] double longest_step() const override { return search_.longest_step(); }
  [[nodiscard]] double energy(const numerics::DaePoint& at) const override { return sums(at.y).energy; }
  void add_rates(const numerics::DaePoint& at, const IntegralRates& rates) const override;
  [[nodiscard]] Load load(const numerics::DaePoint& at) const override;

  /// Sums over what is closed; gap and place, on the first wire, are those of the stretch that presses most,
  /// or of the nearest points. Its points: the closed stretches along the first wire. y in SI units.
  [[nodiscard]] ContactSample sample(const numerics::DaePoint& at) const override;
  [[nodiscard]] std::optional<int> held_states() const override { return touches_.held_states(); }
  void take_from_mounts(const numerics::VectorView& y,
                        std::vector<Eigen::Vector3d>& mount_forces) const override;
  [[nodiscard]] Observed observe(const numerics::DaePoint& now, double time_before,
                                 const Eigen::VectorXd& before) override;
  [[nodiscard]] bool is_law() const override { return false; }

 private:
  /// Of closed stretches alone: without a search. y in SI units.
  [[nodiscard]] ContactSample closed_sample(const numerics::VectorView& y) const;
  /// A place on the wire along which the load is integrated, with the nearest point of the other.
  struct QuadraturePoint {
    std::size_t own = 0;  // wire along which it is integrated
    double weight = 0.0;  // [m]
    bool stands = false;  // the nearest point
    std::size_t stretch = 0;
    struct Place {
      int element = 0;
      double u = 0.0;
      int first = 0;  // of the four vertices
      Eigen::Vector4d value, slope, bend;
      std::array<double, 3> share{},
          share_slope{};  // of the edges between the four vertices in the section's turn
    };
    std::array<Place, 2> places;              // on its own wire, on the other
    std::array<double, 2> shape_functions{};  // of the vertices of its own element
  };
  struct Stretch {
    std::size_t own = 0;
    double from = 0.0, to = 0.0;  // material [m]
    double gap = 0.0;             // deepest [m]
  };
  struct ContactCache {
    InputMemo inputs;
    std::vector<QuadraturePoint> nodes;
    std::vector<QuadraturePoint> ends;  // of the stretches, with bristles: see add_end_jacobian
    std::vector<Stretch> stretches;
    std::array<CubicPieces, 2> pieces;
    std::vector<PairGeometry> geometries;  // of the nodes
    std::array<BristleMeans, 2> bristles;  // of both wires
    std::vector<ContactInterval> closed;   // workspace
    std::vector<GapPlace> minima;          // workspace
  };
  /// Forces on the four vertices on which a place depends [N], and the moment that is taken as held [N m].
  struct NodalLoad {
    std::array<Eigen::Vector3d, 4> force;
    Eigen::Vector3d held_moment = Eigen::Vector3d::Zero();
  };
  /// Rows: of either place 12 of forces, 4 of bristles. Columns: of either place 12 of places and 12 of
  /// velocities, 4 of bristles.
  using LocalBlock = Eigen::Matrix<double, 28, 52>;

  const ContactCache& found_at(const numerics::VectorView& y) const;
  void find(const numerics::VectorView& y, ContactCache& found) const;
  void add_up_bristles(const numerics::VectorView& y, ContactCache& found) const;
  void find_along(std::size_t own, const NearElements& near, ContactCache& found) const;
  [[nodiscard]] QuadraturePoint::Place place(std::size_t wire, int element, double u) const;
  [[nodiscard]] PairSide side(std::size_t wire, const QuadraturePoint::Place& place,
                              const numerics::VectorView& y) const;
  [[nodiscard]] PairGeometry geometry(const QuadraturePoint& node, const numerics::VectorView& y) const;
  /// State of the bristle of one of the element's two vertices at a node, and its flow there.
  [[nodiscard]] BristleState bristle_state(const QuadraturePoint& node, std::size_t h, const PairGeometry& g,
                                           const numerics::VectorView& y) const;
  [[nodiscard]] BristleFlow bristle_flow_at(const QuadraturePoint& node, std::size_t h, const PairGeometry& g,
                                            const numerics::VectorView& y) const;
  [[nodiscard]] std::pair<double, double> gap_at(const numerics::VectorView& y, double coordinate) const;
  [[nodiscard]] std::size_t wire_of(const QuadraturePoint& n, std::size_t s) const {
    return s == 0 ? n.own : 1 - n.own;
  }
  /// First of the two of the vertex h of the node's element.
  [[nodiscard]] int bristle_of(const QuadraturePoint& n, int h) const {
    return bristles_[n.own] + 2 * (n.places[0].element + h);
  }
  /// What the node does to the wire of one of its places.
  [[nodiscard]] NodalLoad nodal_load(const QuadraturePoint& node, const PairGeometry& g, std::size_t s) const;
  void add_column(const QuadraturePoint& node, const PairGeometry& g, const PairDirection& d,
                  const numerics::VectorView& y, Eigen::Ref<Eigen::Matrix<double, 28, 1>> column) const;
  void add_node_jacobian(const QuadraturePoint& node, const PairGeometry& g, const numerics::VectorView& y,
                         LocalBlock& block) const;
  /// What the bristles feel of the end of a closed stretch, where p_e vanishes but not its rate: see
  /// ContactPart.
  void add_end_jacobian(const QuadraturePoint& end, const numerics::VectorView& y, LocalBlock& block) const;
  void add_block(const QuadraturePoint& node, const LocalBlock& block,
                 const numerics::PatternValues& into) const;

  WirePair pair_;
  std::array<const wire::RodPart*, 2> rods_;
  WirePairSearch search_;
  ContactTouches touches_;
  std::vector<std::pair<int, int>> coupled_;  // elements in the pattern, in their order
  std::array<int, 2> bristles_{0, 0};         // first of each wire
  numerics::PatternSlots slots_;
  AcceptedPress accepted_;
  mutable ContactCache found_;  // of the last place that was asked for
};

}  // namespace snare::coupling
