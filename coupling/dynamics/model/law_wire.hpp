#pragma once

#include "coupling/contact/contact_law.hpp"
#include "coupling/contact/friction.hpp"
#include "coupling/dynamics/model/arm.hpp"
#include "coupling/dynamics/model/strength.hpp"
#include "coupling/dynamics/model/tightness.hpp"
#include "multibody/spatial.hpp"

#include <Eigen/Core>

#include <functional>
#include <string>

namespace snare::coupling {

/// What a wire between mounts that stand still to each other does to a shaft that pushes it, as a law of the
/// shaft's place says.
struct WirePush {
  double depth = -1.0;                                 ///< travel from first touch [m]; > 0: they touch
  Eigen::Vector2d force = Eigen::Vector2d::Zero();     ///< on the wire, along chord and push [N]
  Eigen::Matrix2d by_place = Eigen::Matrix2d::Zero();  ///< its derivatives by the place [N/m]
  Eigen::Vector2d by_rate = Eigen::Vector2d::Zero();   ///< and by the rate [N s/m]
  double energy = 0.0;                                 ///< stored [J]
  double lost = 0.0;                                   ///< by damping [W], >= 0
};

/// Of the place where the shaft's axis goes through the plane of the wire, along chord and push from the
/// first mount [m], and of its rate along the push [m/s].
using WirePushLaw = std::function<WirePush(const Eigen::Vector2d& place, double rate)>;

/// A round shaft with which wires meet that a law stands for: a segment on z about its frame's origin.
struct MotionShaft {
  std::string name = "shaft";
  MotionCarrier carrier;
  multibody::Pose X_WS;      ///< at the start
  double radius = 0.0;       ///< [m], >= 0
  double half_length = 0.0;  ///< [m], > 0
};

/// A wire without mass for which a law stands, between two mounts on carriers, and the one shaft that it
/// meets.
///                                                                                           theory.md (M.27)
///
/// It holds the shaft on the side away from its bulge. A shaft that is out of its reach along z when it is
/// behind the wire is missed: nothing acts until it has been before it. The mounts of a string stop the
/// shaft: F = (EA/r) d (1 + a d'), d the depth, r its radius with the wire's, a the damping of an elastic
/// foundation.
struct LawWire {
  enum class Kind {
    stretched,  ///< an elastic string, straight and round the shaft: T = EA (l - L)/L
    /// a rod that turns about `from` and is met by the shaft: F(x), x = lever (commanded less actual angle)
    rod,
    push  ///< a law of pushes across the chord, of mounts that stand still to each other
  };
  std::string name = "wire";
  Kind kind = Kind::stretched;
  MotionCarrier from, to;
  Eigen::Vector3d p_from = Eigen::Vector3d::Zero(),
                  p_to = Eigen::Vector3d::UnitX();   ///< of the mounts at the start [m]
  Eigen::Vector3d bulge = Eigen::Vector3d::UnitY();  ///< at the start, across the chord
  double radius = 0.0;                               ///< half the diameter [m], >= 0
  double length = 0.0;                               ///< unstretched [m]; stretched: > 0
  double axial_stiffness = 0.0;                      ///< EA [N]; stretched: > 0
  double axial_time = 0.0;                           ///< stretched: T = EA (e + tau e')/L [s], >= 0
  ContactLaw law;                                    ///< rod: F(x, x')
  /// rod: by which the wire that the law means stands off the rod [m], >= 0, for its tension.
  double standoff = 0.0;
  WirePushLaw push;         ///< of a push
  bool push_jumps = false;  ///< whether its force jumps where they touch
  /// Whether a push was made for a travel and a position along the chord [m]; none: for all.
  std::function<bool(double travel, double position)> covers;
  double side = 1.0;        ///< of a push: 1 with the bulge, -1 against it [-]
  MotionFriction friction;  ///< smooth; acts where the shaft slides along wire and axis; of a push: none
  WireStrength strength = {};
  WireTightness tightness = {};
  MotionShaft shaft;
};

}  // namespace snare::coupling
