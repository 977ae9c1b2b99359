#pragma once

#include "coupling/contact/curve.hpp"

#include <Eigen/Core>

namespace snare::coupling {

/// Signed angle from a to b [rad].
[[nodiscard]] double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
/// A vector of any unit turned left by a right angle: of a radial, the direction of increasing angle about
/// the pin's centre.
[[nodiscard]] Eigen::Vector2d left_of(const Eigen::Vector2d& v);

/// The wire's tangent at a vertex of the curve of contact, in the plane: t = u/|u|.         theory.md (C.1)
struct VertexTangent {
  VertexSlope<2> slope;
  Eigen::Vector2d t;       ///< unit tangent
  Eigen::Vector2d normal;  ///< t turned left by a right angle
  double size = 1.0;       ///< |u|, about the stretch

  /// Change of the direction angle of t for a change of u, (2) [rad]: the angle is n.du/|u|, u being without
  /// unit.
  [[nodiscard]] Eigen::RowVector2d angle_by_u() const { return normal.transpose() / size; }
};
[[nodiscard]] VertexTangent vertex_tangent(const VertexSlope<2>& slope);

/// How a sliding contact stands.
enum class ContactStatus {
  open,      ///< the gap is positive, no force
  touching,  ///< gap and force are zero; how far the pusher comes towards the wire is the unknown
  stick,     ///< pressed, the material point does not move over the pusher
  slip,      ///< pressed, sliding; frictionless contact always slips
  wrapped    ///< the wire lies on the pusher over an arc: see WrappedContact
};

/// Work of a friction over the slips of one step after the other, along a path with a parameter (travel) [m].
///                                                                                     theory.md (C.5)
struct SlipWork {
  double slip = 0.0;    ///< of the step before [m], its sign the direction
  double begin = 0.0;   ///< friction at the beginning of that step [N], >= 0
  double end = 0.0;     ///< parameter at the end of that step [m]
  double length = 0.0;  ///< of that step, in the parameter [m]

  /// Of the next step [J], >= 0: by the parabolas, over the parameter, through the friction and the place at
  /// its ends and at the beginning of the step before; by the mean friction where the slip or the path has
  /// turned round or the step before was short. next: slip [m]; at: parameter at its end [m]; from, to:
  /// friction at its ends [N], >= 0.
  [[nodiscard]] double over(double next, double at, double from, double to) const;
  /// The state after that step: next [m], at [m] and from [N] as above.
  [[nodiscard]] SlipWork after(double next, double at, double from) const {
    return {next, from, at, at - end};
  }
};

/// A round, rigid pin that the wire slides over at a mesh-carrying vertex.          theory.md (C.2)-(C.6)
///
/// The vertex sits at x = p + (R + g) n with the wire's own normal n = side * (t turned left), so that the
/// contact is tangent and the vertex is the material point of contact; the material coordinate of the vertex
/// is the unknown that sliding changes. R = 0 is a knife edge.
struct SlidingContact {
  int node = 0;     ///< vertex
  int control = 1;  ///< control (material coordinate) that moves with it
  /// +1: the pin lies to the right of the wire and pushes it to the left; -1: the reverse
  double side = 1.0;
  double radius = 0.0;                               ///< of the pin plus that of the wire [m], >= 0
  double friction = 0.0;                             ///< Coulomb coefficient, >= 0
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< at parameter 0 [m]
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< d centre / d parameter; unit or zero
  ContactStatus status = ContactStatus::slip;
  /// Of the increase of material coordinate + side R angle, when it slips: +1, -1 [-]
  double slip_sign = 0.0;
  /// The gauge of a wire on supports: the material point never changes; with friction it rolls
  bool holds_material = false;
  double last_coordinate = 0.0;  ///< material coordinate at the last accepted state [m]
  Eigen::Vector2d last_tangent = Eigen::Vector2d::UnitX();  ///< t at the last accepted state
  /// On the wire at the last accepted state [N]
  Eigen::Vector2d last_force = Eigen::Vector2d::Zero();
  double last_gap = 0.0;  ///< at the last accepted state [m]
  SlipWork slip_work{};

  /// Unit vector from the pin towards the wire, normal to the chord: how it comes to the first touch.
  [[nodiscard]] Eigen::Vector2d approach() const { return side * Eigen::Vector2d::UnitY(); }
};

/// A material vertex that lies on the pusher when the wire wraps it.                 theory.md (C.7)
struct WrappedContact {
  int node = 0;
  /// Coulomb coefficient [-], >= 0.
  double friction = 0.0;
  ContactStatus status = ContactStatus::slip;  ///< stick or slip
  double slip_sign = 0.0;                      ///< of the increase of its angle about the pin's centre
  Eigen::Vector2d last_radial = Eigen::Vector2d::UnitY();  ///< unit vector from the pin's centre
  /// On the wire at the last accepted state [N]
  Eigen::Vector2d last_force = Eigen::Vector2d::Zero();
  SlipWork slip_work{};
};

}  // namespace snare::coupling
