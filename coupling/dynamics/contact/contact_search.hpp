#pragma once

#include "coupling/dynamics/contact/bezier_wire.hpp"
#include "coupling/dynamics/joints/body_part.hpp"
#include "coupling/dynamics/model/model.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace snare::coupling {

/// The nearest point of a wire to a shape.
struct NearestPoint {
  double coordinate = 0.0;  ///< material [m]
  double gap = 0.0;         ///< [m]
};

/// Which elements of a wire come near a shape, and how long a step may be that nothing else does.
///                                                                                     theory.md (G.6), (G.8)
class ContactSearch {
 public:
  ContactSearch(const MotionContact& contact, std::shared_ptr<const ContactShape> shape,
                const wire::RodPart& rod, const BodyPart& body);

  /// The wire's curve, element by element.
  [[nodiscard]] const BezierWire& curve() const { return curve_; }
  /// What it is searched against.
  [[nodiscard]] const ContactShape& shape() const { return *shape_; }
  /// On a shorter way along the wire the gap has one minimum at most [m].
  [[nodiscard]] double resolution() const { return resolution_; }
  /// The place of the wire with the least gap, over all elements [m].
  [[nodiscard]] NearestPoint nearest(const numerics::VectorView& y) const;

  /// Told the unknowns y (SI units) of an accepted state.
  void update(const numerics::VectorView& y);
  /// Elements that may be touched before the next accepted state, in their order.
  [[nodiscard]] const std::vector<int>& candidates() const { return candidates_; }
  /// A step in which no other element can be touched, and none passed by, at twice the speeds of the state
  /// [s]; infinite at rest.
  [[nodiscard]] double longest_step() const { return longest_step_; }

  /// Of the shape's frame in the world at unknowns y (SI units).
  [[nodiscard]] multibody::Pose X_WS(const numerics::VectorView& y) const;
  /// Control points of an element in the shape's frame [m], y in SI units.
  [[nodiscard]] BezierWire::Control control(const multibody::Pose& X_WS, int element,
                                            const numerics::VectorView& y) const;
  /// A gap that no place of an element goes below [m], by its control points in the shape's frame [m].
  [[nodiscard]] double lower_bound(const BezierWire::Control& control) const;

 private:
  std::shared_ptr<const ContactShape> shape_;
  multibody::Pose X_BS_;
  double wire_radius_;
  const wire::RodPart& rod_;
  const BodyPart& body_;
  BezierWire curve_;
  double resolution_ = 0.0;
  double margin_ = 0.0;             // an element this near is a candidate [m]
  double thickness_ = 0.0;          // of wire and shape: no step passes it [m]
  double passed_ = 0.0;             // way that anything has gone since the start [m]
  std::vector<double> free_until_;  // of every element: what it cannot be touched before [m]
  std::vector<double> last_bound_;  // of every element: its gap at least, when it was looked up last [m]
  Eigen::Matrix3Xd last_;           // vertices of the last state, in the shape's frame [m]
  Eigen::VectorXd speeds_;          // of the vertices against the shape [m/s]
  std::vector<int> candidates_;
  double longest_step_ = 0.0;
};

}  // namespace snare::coupling
