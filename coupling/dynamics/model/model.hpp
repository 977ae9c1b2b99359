#pragma once

#include "coupling/contact/contact_law.hpp"
#include "coupling/contact/foundation.hpp"
#include "coupling/contact/friction.hpp"
#include "coupling/contact/shape.hpp"
#include "coupling/dynamics/model/arm.hpp"
#include "coupling/dynamics/model/body_contact.hpp"
#include "coupling/dynamics/model/bushing.hpp"
#include "coupling/dynamics/model/frame_load.hpp"
#include "coupling/dynamics/model/law_wire.hpp"
#include "coupling/dynamics/model/phase.hpp"
#include "coupling/dynamics/model/robot.hpp"
#include "coupling/dynamics/model/strength.hpp"
#include "coupling/dynamics/model/tightness.hpp"
#include "multibody/rigid_body.hpp"
#include "multibody/spatial.hpp"
#include "wire/motion/rod_part.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace snare::coupling {

/// A wire in motion. The world frame is the wire's own: its mounts are given there.
struct MotionWire {
  std::string name = "wire";
  wire::RodInMotion rod;       ///< constants, mounts, damping and mesh
  Eigen::Matrix3Xd positions;  ///< of the vertices at the start [m]: see straight_wire, resting_wire
  /// [m/s]; empty: with its carriers (CarriedWire), at rest between mounts in the world.
  Eigen::Matrix3Xd velocities;
  WireStrength strength = {};
  WireTightness tightness = {};
};

/// A free rigid body.
struct MotionBody {
  std::string name = "body";
  multibody::RigidBodyProperties properties;
  multibody::RigidBodyState start;
  /// Constant, in the world frame, at the centre of mass [N].
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double linear_drag = 0.0;   ///< force -c v [N s/m], >= 0
  double angular_drag = 0.0;  ///< torque -c w [N m s/rad], >= 0
  /// Moved as prescribed instead of freely: constant start.velocity, or the course, and no rotation (a
  /// machine).
  bool driven = false;
  /// Of a driven body: velocity [m/s] at a time [s], continuous, and its derivative [m/s^2]. Both or none.
  std::function<Eigen::Vector3d(double time)> course_velocity, course_acceleration;
  /// Of a driven body without a course: a robot plays a body that is free.
  std::optional<MotionRobot> robot;
};

/// A shape that belongs to a body and may touch a wire, at several points at a time.
struct MotionContact {
  std::string name = "contact";
  int wire = 0;                               ///< index
  int body = 0;                               ///< index
  std::shared_ptr<const ContactShape> shape;  ///< in a frame S fixed to the body
  multibody::Pose X_BS;                       ///< of the shape's frame in the body's
  double wire_radius = 0.0;  ///< half the wire's diameter [m], >= 0; > 0 for a shape with edges
  ElasticFoundation foundation;
  MotionFriction friction;
  /// The papers' contact laws in place of the foundation: normal force [N] of the deepest penetration [m] and
  /// its rate [m/s], with the derivatives by both; never negative. At every local minimum of the gap.
  ContactLaw law;
};

/// Two wires that may touch each other, crossing or side by side, wherever and as often as they do.
///                                                                                           theory.md (M.20)
struct WirePair {
  std::string name = "pair";
  std::array<int, 2> wires{0, 1};         ///< indices of two wires
  std::array<double, 2> radii{0.0, 0.0};  ///< half their diameters [m], > 0
  ElasticFoundation foundation;           ///< between them; modulus 0: the smaller of their defaults
  MotionFriction friction;
};

/// A contact law between a point of a body and a plane fixed in the world, which stands for a whole wire.
struct PointContactLaw {
  std::string name = "spring";
  int body = 0;                                          ///< index
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< p_BP, of the probe [m]
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< of the probe at first touch [m]
  double origin_speed = 0.0;                             ///< at which the plane moves along `direction` [m/s]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitY();  ///< of the push, unit
  ContactLaw law;                                        ///< of penetration along `direction` and its rate
};

/// What every wire has, whatever stands for it.
struct WireFacts {
  std::string name;
  WireStrength strength;
  WireTightness tightness;
};

/// Kinds of what presses, in the order in which results count all of it: shapes on wires, point laws, pairs
/// of wires, wires that laws stand for on their shafts, bodies.
enum class ContactKind { shape, point_law, wire_pair, law_wire, bodies };

/// Everything that moves and acts. Indices count within these lists.
struct Motion {
  std::vector<MotionWire> wires;
  std::vector<MotionBody> bodies;
  std::vector<MotionContact> contacts;
  std::vector<PointContactLaw> point_contacts;
  std::vector<WirePair> wire_pairs;
  std::vector<MotionArm> arms;
  std::vector<MotionWeld> welds;  ///< bodies on arms, on other bodies, on the world
  /// Ends of wires on arms or bodies, and those that give; the others stand still.
  std::vector<MotionMount> mounts;
  std::vector<MotionBushing> bushings;
  std::vector<LawWire> law_wires;  ///< behind the other wires where wires are counted
  std::vector<BodyContact> body_contacts;
  std::vector<FrameLoad> loads;
  std::vector<MotionPhase> phases;                    ///< in their order
  std::vector<SensedSignal> sensed;                   ///< for the phases
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]

  /// Of all wires, in the order in which results count them: those of the list, then those that laws stand
  /// for.
  [[nodiscard]] std::vector<WireFacts> wire_facts() const {
    std::vector<WireFacts> facts;
    for (const MotionWire& w : wires) facts.push_back({w.name, w.strength, w.tightness});
    for (const LawWire& w : law_wires) facts.push_back({w.name, w.strength, w.tightness});
    return facts;
  }

  /// Index of the first of a kind among all that presses.
  [[nodiscard]] std::size_t first_contact(ContactKind kind) const {
    const std::array<std::size_t, 4> counts{contacts.size(), point_contacts.size(), wire_pairs.size(),
                                            law_wires.size()};
    return std::accumulate(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(kind),
                           std::size_t{0});
  }
  /// Kind and index in its list of what presses.
  struct ContactPlace {
    ContactKind kind = ContactKind::shape;
    std::size_t index = 0;
  };
  [[nodiscard]] ContactPlace contact_place(std::size_t contact) const {
    for (const ContactKind kind :
         {ContactKind::bodies, ContactKind::law_wire, ContactKind::wire_pair, ContactKind::point_law})
      if (contact >= first_contact(kind)) return {kind, contact - first_contact(kind)};
    return {ContactKind::shape, contact};
  }
  /// Names of all that presses, in the order in which results count it.
  [[nodiscard]] std::vector<std::string> contact_names() const {
    std::vector<std::string> names;
    for (const MotionContact& c : contacts) names.push_back(c.name);
    for (const PointContactLaw& s : point_contacts) names.push_back(s.name);
    for (const WirePair& p : wire_pairs) names.push_back(p.name);
    for (const LawWire& w : law_wires) names.push_back(w.shaft.name + " on " + w.name);
    for (const BodyContact& b : body_contacts) names.push_back(b.name);
    return names;
  }
};

}  // namespace snare::coupling
