#pragma once

#include "coupling/dynamics/contact/bristle_means.hpp"
#include "coupling/dynamics/joints/body_part.hpp"
#include "coupling/dynamics/model/model.hpp"

#include <Eigen/Core>

#include <array>

namespace snare::coupling {

/// The wire's curve at a material coordinate zeta, and how it moves.                         theory.md (M.6)
struct CurvePoint {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();        ///< X [m]
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();    ///< X' [-]
  Eigen::Vector3d bend = Eigen::Vector3d::Zero();     ///< X'' [1/m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();        ///< sum N v [m/s], zeta kept
  Eigen::Vector3d slope_v = Eigen::Vector3d::Zero();  ///< sum N' v [1/s]
};

/// One point of contact between a wire and a body's shape at one state, in the axes of the world unless said.
///                                                                                      theory.md (M.7)-(M.9)
///   g: gap, n: normal from the body to the wire, H: Hessian of the distance
///   u = e - (n.e) n,  a = u/|u|,  b = n x a: axes of the tangent plane, e = X',
///     or an axis of the world where X' is along n
///   w = v - v_B - omega x r,  r = X - p_WB: velocity of the wire against the body;  dg/dt = n.w
///   lambda(g, o): load by the foundation [N/m], or normal force by a law [N];
///     o: dg/dt or dg/dt - (n.t)(t.w), t = X'/|X'|, or a mean of
/// both, see Opening; lambda_e(g): the part of it that is stored
///   force on the wire, a length or in all: f = lambda n - (friction on the body, in a and b)
/// At a mount o = dg/dt, and e is an axis of the world. Friction with bristles is that of the element's two
/// vertices, weighted by their hats.
struct ContactGeometry : CurvePoint {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();                                      ///< r [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();                                   ///< n
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();                                  ///< H [1/m]
  double gap = 0.0;                                                                   ///< g [m]
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();                                    ///< of the body [rad/s]
  Eigen::Vector3d body_velocity = Eigen::Vector3d::Zero();                            ///< v_B [m/s]
  Eigen::Vector3d relative = Eigen::Vector3d::Zero();                                 ///< w [m/s]
  double gap_rate = 0.0;                                                              ///< dg/dt [m/s]
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();                                ///< t
  Eigen::Vector3d along = Eigen::Vector3d::Zero(), across = Eigen::Vector3d::Zero();  ///< a, b
  bool by_wire = true;                                                                ///< e = X'
  Eigen::Vector3d toward = Eigen::Vector3d::Zero();                                   ///< e
  double run = 0.0;                                                                   ///< |u|
  Eigen::Vector3d load = Eigen::Vector3d::Zero();     ///< lambda, and its derivatives by g and o
  Eigen::Vector3d elastic = Eigen::Vector3d::Zero();  ///< lambda_e, and its first two derivatives by g
  Opening opening;                                    ///< o
  BristleState state;                                 ///< the sliding velocity w in a and b, lambda, lambda_e
  TangentForce friction;
  std::array<TangentForce, 2> of_bristles;          ///< of each vertex's bristle, if there are any
  std::array<double, 2> shape_functions{};          ///< shares of them in `friction`
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< f

  /// dlambda_e/dt [N/(m s)], by a law [N/s].
  [[nodiscard]] double elastic_rate() const { return elastic[1] * gap_rate; }

  /// A vector given in the tangent plane's axes a and b, in the axes of the world; same unit.
  [[nodiscard]] Eigen::Vector3d in_world(const Eigen::Vector2d& tangent) const {
    return tangent.x() * along + tangent.y() * across;
  }
};

/// A place on a wire between its mounts, or that of a mount.
enum class ContactPlace { wire, mount };

/// beside: used only where friction has bristles. y in SI units.
[[nodiscard]] ContactGeometry contact_geometry(const MotionContact& contact, const ContactShape& shape,
                                               const CurvePoint& curve, const BodyPart& body,
                                               const numerics::VectorView& y, const BristlesBeside& beside,
                                               ContactPlace place = ContactPlace::wire);

/// A direction in the space of what a contact depends on.
struct ContactDirection {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();      ///< of X by the vertices, zeta kept
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();  ///< the same of X'
  Eigen::Vector3d v = Eigen::Vector3d::Zero();      ///< of sum N v by the vertices' velocities
  Eigen::Vector3d p = Eigen::Vector3d::Zero();      ///< of p_WB
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();   ///< phi: turn of the body, in the world
  Eigen::Vector3d body_velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();  ///< of omega in the body
  double zeta = 0.0;                               ///< of the material coordinate
  std::array<Eigen::Vector2d, 2> bristles{Eigen::Vector2d::Zero(),
                                          Eigen::Vector2d::Zero()};  ///< of the element's vertices
};

/// What changes along a direction.
struct ContactChange {
  double gap = 0.0, tangency = 0.0, gap_rate = 0.0;  ///< of g, n.X' and dg/dt [m, -, m/s]
  double load = 0.0, elastic = 0.0;                  ///< of lambda and lambda_e [N/m], by a law [N]
  double elastic_rate = 0.0;                         ///< of dlambda_e/dt [N/(m s)], by a law [N/s]
  Eigen::Vector2d sliding = Eigen::Vector2d::Zero(), friction = Eigen::Vector2d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< on the wire
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< on the body about its centre of mass, in the body
};

/// How gap, load, friction, force and torque change along `d` at the place `g`: the first derivative of
/// contact_geometry, linear in d.
[[nodiscard]] ContactChange contact_change(const MotionFriction& friction, const ContactGeometry& g,
                                           const ContactDirection& d);

}  // namespace snare::coupling
