#pragma once

#include "numerics/report.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace snare::coupling {

/// Something that happened along the path. to_string has their names in this order.
struct PushEvent {
  enum class Kind {
    first_touch,
    lift_off,
    touch,
    slip_begins,
    slip_ends,
    wrap_begins,
    wrap_ends,
    mount_slips,
    mount_holds,
    fold,         ///< the travel turns back along the path: under control of the travel the wire snaps here
    bifurcation,  ///< another branch crosses; beyond it this one is unstable
    snap          ///< the wire jumped to another stable shape
  };
  Kind kind{};
  double travel = 0.0;  ///< [m]
};
[[nodiscard]] std::string to_string(PushEvent::Kind kind);

/// One point of a force-displacement curve. SI units.
struct PushPoint {
  double travel = 0.0;            ///< of the pusher from first touch [m]
  double force = 0.0;             ///< on the pusher along the push, positive when the wire resists [N]
  double transverse_force = 0.0;  ///< on the pusher across the push, along the chord [N]
  double normal_force = 0.0;      ///< of the pusher on the wire, all contact points together [N], >= 0
  double friction_force = 0.0;    ///< along the wire, the same way [N]; |friction| <= mu normal
  double axial_force = 0.0;       ///< on the pusher along z, where it is tilted [N]
  /// Axial force in the wire at the left mount, tension positive [N]: theory.md (W.36)
  double tension_left = 0.0;
  double tension_right = 0.0;    ///< at the right mount [N]
  double largest_tension = 0.0;  ///< along the wire, its ends included, tension positive [N]
  /// Force of a mount, or of a support, on the wire [N]: along the chord from the left mount to the right
  /// one; across it, in the sense of the bulge; along z, out of their plane. The two, the pusher's force and
  /// the weight add up to zero.
  double reaction_along_left = 0.0, reaction_across_left = 0.0, reaction_z_left = 0.0;
  double reaction_along_right = 0.0, reaction_across_right = 0.0, reaction_z_right = 0.0;
  /// Material coordinate of the (middle of the) contact from the left mount [m]
  double contact_coordinate = 0.0;
  double bending_moment = 0.0;  ///< largest in the wire [N m], >= 0; of a push in space not known, 0
  double wrapped_length = 0.0;  ///< length of wire that lies on the pusher [m]; 0 for contact at a point
  double energy = 0.0;          ///< elastic energy and potential of the weight [J]
  double dissipated = 0.0;      ///< friction work so far [J], never decreasing
  double imbalance = 0.0;       ///< |mounts + pusher + weight| [N]: action and reaction
  int out_of_plane_modes = 0;   ///< unstable ones that leave the plane, when asked for
  int unstable_modes = 0;       ///< negative eigenvalues of the constrained tangent: 0 is stable
  bool in_contact = true;
  bool slipping = false;  ///< friction only: the contact slides
  /// Rate form of the wire by the travel, when asked for [N/m]: theory.md (W.14)
  double viscous_stiffness = 0.0;
  std::vector<double> force_by;  ///< d force / d number of every variation asked for
  int iterations = 0;            ///< Newton iterations since the point before
  bool converged = true;
};

/// Shape of the wire at one point, for plots. SI units, one entry a vertex (tension: the mean of its edges).
struct PushShape {
  double travel = 0.0;
  Eigen::Vector2d pusher_centre = Eigen::Vector2d::Zero();
  std::vector<double> x, y, arc, tension, moment;
};

/// What a push has given, point by point in the order visited; on failure as far as it came.
struct PushCurve {
  std::vector<PushPoint> points;
  std::vector<PushEvent> events;
  std::vector<PushShape> shapes;
  double natural_height = 0.0;  ///< of the wire at the contact before the push [m]
  double touch_height = 0.0;    ///< of the pusher's centre at first touch [m]
  int newton_iterations = 0;    ///< all, with those of the initial shape
  /// Travels at which the steps of the path's own ended [m], one list from each turning point to the next.
  /// Empty where the points are the steps
  std::vector<std::vector<double>> steps;
  numerics::SolveReport report;  ///< why it ended; `points` hold what was reached
};

}  // namespace snare::coupling
