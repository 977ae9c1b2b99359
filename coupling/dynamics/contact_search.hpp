#pragma once

#include "coupling/dynamics/body_part.hpp"
#include "coupling/dynamics/model.hpp"
#include "numerics/ida.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace snare::coupling {

/// The C1 curve of a wire (M.6), element by element as cubics in Bernstein form: each stays in the convex hull of its
/// four control points, and so does every derivative by time in the hull of theirs.          theory.md (G.6)
class BezierWire {
 public:
  using Control = Eigen::Matrix<double, 3, 4>;

  /// The rod stays the caller's; where its unknowns are is asked when they are wanted.
  explicit BezierWire(const wire::RodPart& rod);

  [[nodiscard]] int elements() const { return static_cast<int>(pieces_.size()); }
  /// Control points of an element, from positions [m] or any derivative of them by time, in the layout of the unknowns.
  [[nodiscard]] Control control(int element, const numerics::VectorView& y) const;
  [[nodiscard]] double begin(int element) const { return pieces_[static_cast<std::size_t>(element)].begin; }    ///< [m]
  [[nodiscard]] double length(int element) const { return pieces_[static_cast<std::size_t>(element)].length; }  ///< [m]
  /// Largest sum of the moduli of a control point's weights: bounds control points by vertices.
  [[nodiscard]] double largest_weight_sum() const { return largest_weight_sum_; }
  /// Largest modulus of the vertices' three-vectors in the layout of the unknowns, each less `offset`.
  [[nodiscard]] double largest(const Eigen::VectorXd& y, const Eigen::Vector3d& offset) const;

 private:
  struct Piece {
    double begin = 0.0, length = 0.0;
    int first = 0;            // of four vertices
    Eigen::Matrix4d weights;  // of vertices (rows) in control points (columns)
  };
  std::vector<Piece> pieces_;
  const wire::RodPart& rod_;
  double largest_weight_sum_ = 1.0;
};

/// A local minimum of the gap along a wire.
struct GapMinimum {
  double coordinate = 0.0;  ///< material [m]
  double gap = 0.0;         ///< [m]
};

/// Finds where a wire comes near a shape, and when first within a step of the integrator.       theory.md (G.6)-(G.8)
class ContactSearch {
 public:
  ContactSearch(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body,
                double position_tolerance);

  /// Local minima of the gap below `reach` [m] along the wire, ends of the wire included. Two of them on a stretch shorter than
  /// `resolution` may count as one.
  [[nodiscard]] std::vector<GapMinimum> minima(const numerics::VectorView& y, double reach) const;
  /// The least of them, however far.
  [[nodiscard]] GapMinimum nearest(const numerics::VectorView& y) const;
  /// A lower bound of the gap anywhere on the wire [m].
  [[nodiscard]] double clearance(const numerics::VectorView& y) const;
  [[nodiscard]] double resolution() const { return resolution_; }

  /// A closed point: the unknown that is its material coordinate, how far from there a minimum may stand to be its own [m], and how deep
  /// dips around it are no touches [m].
  struct Held {
    int unknown = 0;
    double within = 0.0;
    double around = 0.0, depth = 0.0;
  };
  /// Of the integrator's last step, for all contacts.
  struct Step {
    const numerics::Ida& ida;
    double from = 0.0, to = 0.0;               ///< [s]
    std::vector<Eigen::VectorXd> derivatives;  ///< of the unknowns at its end, from the first on
  };
  /// First time in [step.from, until] at which a local minimum other than those `held` falls to `touch` [m, <= 0]: conservative
  /// advancement, which no speed and no thin shape passes by. Minima that dip by less than `skip_depth` between two positive gaps may be
  /// missed.
  [[nodiscard]] std::optional<double> first_touch(const Step& step, double until, const std::vector<Held>& held,
                                                  double touch);
  /// Those minima at a state whose gap is at most `touch`.
  [[nodiscard]] std::vector<GapMinimum> touching(const numerics::VectorView& y, const std::vector<Held>& held,
                                                 double touch) const;
  /// Of the wire [m].
  [[nodiscard]] double longest_element() const { return longest_element_; }
  [[nodiscard]] double skip_depth() const { return skip_depth_; }
  /// The state is another than the end of the last step: what was found out there is forgotten.
  void forget();
  /// A lower bound of the gap at the end of the last step; <= 0 when none is known [m].
  [[nodiscard]] double known_clearance() const;

 private:
  struct Place;
  struct Interval;
  [[nodiscard]] multibody::Pose X_WS(const numerics::VectorView& y) const;
  [[nodiscard]] Place place(const multibody::Pose& X_WS, const BezierWire::Control& control, int element,
                            double u) const;
  [[nodiscard]] double lower_bound(const multibody::Pose& X_WS, const Eigen::AlignedBox3d& box) const;
  [[nodiscard]] std::vector<int> near_elements(const multibody::Pose& X_WS, const numerics::VectorView& y, double reach,
                                               double& least) const;
  void subdivide(const multibody::Pose& X_WS, int element, const BezierWire::Control& whole,
                 const BezierWire::Control& part, const Place& from, const Place& to, double reach,
                 std::vector<Interval>& out) const;
  [[nodiscard]] std::vector<GapMinimum> minima_of(const std::vector<int>& elements, const numerics::VectorView& y,
                                                  double reach) const;
  [[nodiscard]] std::vector<GapMinimum> flat_vertices(const numerics::VectorView& y, double touch) const;
  [[nodiscard]] std::vector<GapMinimum> open_minima(std::vector<GapMinimum> all, const numerics::VectorView& y,
                                                    const std::vector<Held>& held) const;
  [[nodiscard]] std::vector<int> met_within(double way, const numerics::VectorView& y);
  [[nodiscard]] double speed_bound(const Step& step) const;
  [[nodiscard]] double speed_bound(const Step& step, const std::vector<int>& elements) const;

  std::shared_ptr<const ContactShape> shape_;
  multibody::Pose X_BS_;
  double wire_radius_;
  const wire::RodPart& rod_;
  const BodyPart& body_;
  BezierWire curve_;
  double resolution_ = 0.0;
  double skip_depth_ = 0.0;
  double longest_element_ = 0.0;
  double passed_ = 0.0;             // way that anything can have gone since the start [m]
  std::vector<double> free_until_;  // of every element: what it cannot be touched before
  std::vector<int> asked_;          // elements whose distance was looked up in the last step
};

}  // namespace snare::coupling
