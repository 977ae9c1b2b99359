#pragma once

#include "wire/specification.hpp"

#include <array>
#include <vector>

namespace snare::coupling {

/// On which side of the wire the pusher comes.
enum class PushDirection {
  outward,  ///< with the bulge
  inward    ///< against it
};

/// The rigid pusher: a cylinder whose axis is normal to the plane of the wire.
struct PusherSpecification {
  double radius = 0.0;      ///< [m], >= 0; 0 is a knife edge, a line that meets the wire's centreline
  double friction = 0.0;    ///< Coulomb coefficient [-], >= 0
  double compliance = 0.0;  ///< by which the machine gives way along the push [m/N], >= 0
  PushDirection direction = PushDirection::outward;
  double tilt = 0.0;  ///< the axis leans in the plane of chord and axis, about the push direction [rad]
  double misalignment = 0.0;  ///< the push direction turned in the plane of the wire, towards +x [rad]
};

/// Shape of the loose wire before the push.
struct BulgeSpecification {
  int mode = 1;  ///< buckling mode between the mounts, 1 to 4
  /// Plane of the bulge before the push, turned about the chord from the plane of the push [rad], |plane| <=
  /// pi/2. An unloaded wire swings about its chord without force, so the push starts where it has swung into
  /// its plane.
  double plane = 0.0;
};

/// What to do where the path of equilibria turns unstable.
enum class Instability {
  follow_path,   ///< stay on the path, by arc length through folds; unstable points are marked
  switch_branch  ///< leave it at a bifurcation for the branch that is stable
};

/// One quasi-static push on one loose wire: everything the prediction of a force-displacement curve needs.
struct PushProblem {
  wire::WireSpecification wire;
  wire::MountSpecification mount;
  PusherSpecification pusher;
  BulgeSpecification bulge;
  std::array<double, 3> gravity{0.0, 0.0, 0.0};  ///< [m/s^2] in chord axes
  double contact_position = 0.0;  ///< of the pusher's axis along the chord, from the left mount [m]
  std::vector<double> travel;     ///< of the pusher from first touch, in the order it is visited [m]
};

}  // namespace snare::coupling
