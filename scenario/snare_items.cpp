#include "scenario/snare_items.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "coupling/contact/revolved_solids.hpp"
#include "multibody/kinematics.hpp"
#include "scenario/drive_reader.hpp"
#include "scenario/motion_reader.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace snare::scenario {

using base::at;
using base::degree;
using base::mm;
using base::Range;
using base::TomlTable;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using multibody::Pose;

namespace {

/// A joint that a snare brings: what it moves, and the motor that moves it through a gear.
struct SnareJoint {
  double load = 0.0;  ///< inertia of the ring about its axis [kg m^2], or mass of the carriage [kg]
  multibody::ElasticJoint joint;
  multibody::Drive drive;
  double start = 0.0;  ///< [rad], [m]
};

}  // namespace

struct Snares::Item {
  TomlTable table;
  std::string name;
  Pose X_FS;  ///< in its frame: z is the axis of the rings
  double radius = 0.0;
  double first_azimuth = 0.0;
  double sense = 1.0;  ///< of the turning ring about z
  std::vector<double> heights = {};
  SnareJoint ring = {};
  std::optional<SnareJoint> carriage = {};
  std::optional<DeclaredWire> wire = {};

  /// Of the place of a wire on the fixed ring, to either side that the ring turns.           theory.md (M.24)
  [[nodiscard]] double azimuth(std::size_t k) const {
    return first_azimuth +
           2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(heights.size());
  }

  /// A ring with a spoke at the place of every wire, so that its turning can be seen.
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> ring_drawing() const {
    constexpr int corners = 72;
    std::vector<Eigen::Matrix3Xd> lines{coupling::circle_drawing(radius, 0.0, corners)};
    for (std::size_t k = 0; k < heights.size(); ++k) {
      const Vector3d outward(std::cos(azimuth(k)), std::sin(azimuth(k)), 0.0);
      Eigen::Matrix3Xd spoke(3, 2);
      spoke << radius * outward + heights[k] * Vector3d::UnitZ(), 1.1 * radius * outward;
      lines.push_back(spoke);
    }
    return lines;
  }
};

namespace {

SnareJoint read_joint(const TomlTable& table, const std::string& name, bool slides) {
  SnareJoint j;
  j.load = slides ? table.number_or("mass_kg", 1.0, Range::above(0.0, 1e6))
                  : table.number_or("inertia_kg_m2", 0.01, Range::above(0.0, 1e6));
  j.joint.name = name;
  j.joint.motor_inertia = slides ? table.number_or("motor_mass_kg", 10.0, Range::above(0.0, 1e9))
                                 : table.number_or("motor_inertia_kg_m2", 0.1, Range::above(0.0, 1e9));
  const double stiffness = slides ? table.number_or("stiffness_N_m", 1e8, Range::above(0.0, 1e15))
                                  : table.number_or("stiffness_Nm_rad", 1e5, Range::above(0.0, 1e15));
  const double damping = slides ? table.number_or("damping_Ns_m", 1e4, Range::from(0.0, 1e12))
                                : table.number_or("damping_Nms_rad", 10.0, Range::from(0.0, 1e12));
  if (stiffness > 0.0 && damping >= 0.0)
    j.joint.spring = multibody::DeflectionLaw::linear(stiffness, damping);
  j.joint.back_drive = table.number_or(slides ? "back_drive_N" : "back_drive_Nm", 0.0, Range::from(0.0, 1e9));
  j.start = slides ? table.number_or("start_mm", 0.0, Range::from(-1e4, 1e4), mm)
                   : table.number_or("start_deg", 115.0 * degree, Range::from(0.0, 360.0), degree);
  j.drive = multibody::Drive::locked();
  return j;
}

/// Radius to which a pinned wire of a length bows between mounts of a ring that are an angle apart, as an
/// arc: a lower bound.
double arc_bow(double radius, double angle) {
  return radius * (1.0 - std::cos(0.5 * angle));
}

}  // namespace

Snares::~Snares() = default;

Snares::Snares(Composition& composition) : c_(composition) {
  for (const TomlTable& table : c_.document.root().tables("snares")) {
    Item item{table, c_.arm_names.take(table), read_pose_in_frame(table)};
    item.radius = table.number("ring_radius_mm", Range::above(0.0, 1e4), mm);
    item.first_azimuth = table.number_or("first_wire_deg", 0.0, Range::from(-360.0, 360.0), degree);
    static constexpr base::Choice<double> senses[] = {{"left", 1.0}, {"right", -1.0}};
    if (table.has("turns")) item.sense = table.choice("turns", senses).value_or(1.0);
    item.ring = read_joint(table.table("ring"), item.name + "::ring", false);
    if (table.has("carriage"))
      item.carriage = read_joint(table.table("carriage"), item.name + "::carriage", true);
    const int count = table.integer_or("wires", 3, 0, 12);
    double step = 0.0;
    if (count > 0) {
      item.wire = read_wire_item(table.table("wire"), c_.damping, wire::SpatialEnd::Kind::twisting_pin);
      step = 2.0 * item.wire->specification.diameter;
    } else {
      for (const char* key : {"wire", "wire_contact", "wall", "heights_mm"}) {
        if (table.has(key)) table.fail(key, "cannot stand beside wires = 0");
      }
    }
    if (table.has("heights_mm") && count > 0) {
      item.heights = table.numbers("heights_mm", at(count), at(count), Range::from(-1e4, 1e4), mm);
    } else {
      for (int k = 0; k < count; ++k) item.heights.push_back((k - 0.5 * (count - 1)) * step);
    }
    item.heights.resize(at(count), 0.0);
    items_.push_back(std::move(item));
  }
  for (const Item& item : items_) {
    c_.placement.stand(item.table, "frame", item.name,
                       [this, &item](const PlacedFrame& on, Placement&) { place(item, on); });
  }
}

// The rings become bodies of the tree of the arm that carries them, or of one of their own on the world.
void Snares::place(const Item& item, const PlacedFrame& on) {
  if (on.carrier.kind == coupling::MotionCarrier::Kind::body) {
    item.table.fail("frame", "must be fixed in the world or on an arm");
    return;
  }
  const Pose X_WS = on.X_WF * item.X_FS;
  int index = on.carrier.index;
  int frame = on.carrier.frame;
  if (on.carrier.kind == coupling::MotionCarrier::Kind::world) {
    index = static_cast<int>(c_.motion.arms.size());
    frame = 0;
    c_.motion.arms.emplace_back().name = item.name;
  }
  coupling::MotionArm& arm = c_.motion.arms[at(index)];
  multibody::Tree& tree = arm.arm.tree;
  // Of another snare of its name, which has been told, or of a link of the arm.
  for (const char* own : {"::housing", "::carriage", "::fixed", "::turning"}) {
    if (tree.find_frame(item.name + own) < 0) continue;
    item.table.fail("name", fmt::format("must be another: the frame {}{} is there already", item.name, own));
    return;
  }
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, arm.start.q.size() > 0 ? arm.start.q : Eigen::VectorXd(0), kinematics);
  const Pose X_FS = multibody::frame_pose(tree, kinematics, frame).inverse() * X_WS;

  std::vector<double> start;
  int base = tree.add_fixed(frame, item.name + "::housing", X_FS);
  const auto add = [&](const SnareJoint& j, const std::string& body, multibody::JointKind kind,
                       double sense) {
    const double mass =
        kind == multibody::JointKind::prismatic ? j.load : 2.0 * j.load / (item.radius * item.radius);
    // A hoop: half as much across the axis. The carriage turns with what carries it: as a hoop of its mass.
    const double about_axis =
        kind == multibody::JointKind::prismatic ? mass * item.radius * item.radius : j.load;
    const Vector3d inertia(0.5 * about_axis, 0.5 * about_axis, about_axis);
    base = tree.add_moving(
        base, body, kind, sense * Vector3d::UnitZ(), {},
        multibody::SpatialInertia::about_centre(mass, Vector3d::Zero(), inertia.asDiagonal()));
    multibody::ElasticJoint joint = j.joint;
    joint.body = tree.size() - 1;
    c_.joints[j.joint.name] = {index, arm.arm.motors(), kind == multibody::JointKind::prismatic};
    arm.arm.joints.push_back(joint);
    multibody::Drive drive = j.drive;
    drive.course = multibody::Course::standing(j.start);
    arm.drives.push_back(drive);
    start.push_back(j.start);
  };
  if (item.carriage) add(*item.carriage, item.name + "::carriage", multibody::JointKind::prismatic, 1.0);
  const int fixed = tree.add_fixed(base, item.name + "::fixed", {});
  base = fixed;
  add(item.ring, item.name + "::turning", multibody::JointKind::revolute, item.sense);

  const auto extend = [&start](Eigen::VectorXd& v, bool with) {
    const Eigen::Index n = v.size();
    v.conservativeResize(n + static_cast<Eigen::Index>(start.size()));
    for (std::size_t k = 0; k < start.size(); ++k)
      v[n + static_cast<Eigen::Index>(k)] = with ? start[k] : 0.0;
  };
  extend(arm.start.q, true);
  extend(arm.start.v, false);
  extend(arm.start.motor, true);
  extend(arm.start.motor_rate, false);
  multibody::Kinematics now(tree);
  multibody::place(tree, arm.start.q, now);
  for (const char* own : {"housing", "carriage", "fixed", "turning"}) {
    const int f = tree.find_frame(item.name + "::" + own);
    if (f < 0) continue;
    const PlacedFrame placed{{coupling::MotionCarrier::Kind::arm, index, f},
                             multibody::frame_pose(tree, now, f)};
    c_.placement.add(item.name + "::" + own, placed);
    const bool is_ring = std::string_view(own) == "fixed" || std::string_view(own) == "turning";
    if (is_ring && item.wire)
      c_.drawn.push_back({item.name + "::" + own, placed.carrier, placed.X_WF, item.ring_drawing()});
  }
}

// Wire k from the fixed ring at the azimuth of its place to the turning ring, which at zero is over the fixed
// one.
void Snares::add_wires() {
  for (Item& item : items_) {
    if (!item.wire) continue;
    const std::optional<PlacedFrame> fixed = c_.placement.find(item.name + "::fixed");
    const std::optional<PlacedFrame> turning = c_.placement.find(item.name + "::turning");
    if (!fixed || !turning) continue;
    const TomlTable table = item.table.table("wire");
    c_.snares[item.name].sense = item.sense;
    const std::size_t first = c_.wires.size(), count = item.heights.size();
    for (std::size_t k = 0; k < count; ++k) {
      DeclaredWire w = *item.wire;
      w.wire.name = fmt::format("{}::wire_{}", item.name, k + 1);
      const double azimuth = item.azimuth(k);
      const Vector3d mount = AngleAxisd(azimuth, Vector3d::UnitZ()) * Vector3d(item.radius, 0.0, 0.0) +
                             item.heights[k] * Vector3d::UnitZ();
      w.from = fixed->X_WF.p + fixed->X_WF.R * mount;
      w.to = turning->X_WF.p + turning->X_WF.R * mount;
      w.from_carrier = fixed->carrier;
      w.to_carrier = turning->carrier;
      const double middle = azimuth + 0.5 * item.sense * item.ring.start;
      w.bulge = fixed->X_WF.R * (AngleAxisd(middle, Vector3d::UnitZ()) * Vector3d::UnitX());
      stretch(w, table, "length_mm", "");
      c_.wire_names.add(w.wire.name);
      c_.snares[item.name].wires.push_back(static_cast<int>(c_.wires.size()));
      c_.wires.push_back(w);
    }
    c_.model_keys.push_back(table.address() + ".model");
    if (count < 2 || !table.boolean_or("touch_each_other", true)) continue;
    const coupling::WirePair law = read_pair_law(item.table.table("wire_contact"));
    if (item.wire->law) continue;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) {
        coupling::WirePair pair = law;
        pair.name = fmt::format("{} on {}", c_.wires[first + i].wire.name, c_.wires[first + j].wire.name);
        pair.wires = {c_.counted(static_cast<int>(first + i)), c_.counted(static_cast<int>(first + j))};
        pair.radii = {0.5 * item.wire->specification.diameter, 0.5 * item.wire->specification.diameter};
        c_.pair_names.add(pair.name);
        c_.motion.wire_pairs.push_back(pair);
      }
    }
  }
}

void Snares::add_walls() {
  for (const Item& item : items_) {
    if (!item.wire || !item.table.has("wall")) continue;
    const TomlTable table = item.table.table("wall");
    const double inner = table.number("radius_mm", Range::above(0.0, 1e4), mm);
    const double length = table.number_or("length_mm", 60.0 * mm, Range::above(0.0, 1e5), mm);
    const double thickness = table.number_or("thickness_mm", 5.0 * mm, Range::above(0.0, 1e3), mm);
    const double mass = table.number_or("mass_kg", 5.0, Range::above(0.0, 1e6));
    // Where pinned wires bow beyond it, they begin pressed by it; others must clear it.
    const double half = 0.5 * item.wire->specification.diameter;
    const bool may_press =
        !item.wire->law && item.wire->wire.rod.properties.left.kind == wire::SpatialEnd::Kind::twisting_pin;
    const double bow = item.radius * std::cos(0.5 * item.ring.start) + arc_bow(item.radius, item.ring.start);
    const double least = (may_press ? item.radius : std::max(item.radius, bow)) + half;
    if (!(inner > least))
      table.fail("radius_mm", fmt::format("must be > {:.6g}, that of the ring with half a wire", least / mm));
    coupling::MotionContact wall;
    wall.friction = read_friction(table, table.number_or("friction", 0.0, Range::from(0.0, 5.0)), "friction");
    wall.foundation = read_foundation(table.table("foundation"));
    const std::optional<PlacedFrame> housing = c_.placement.find(item.name + "::housing");
    if (!housing || !(inner > 0.0) || !(length > 0.0) || !(thickness > 0.0)) continue;
    wall.shape = coupling::hollow_cylinder(inner, inner + thickness, length, 0.0);
    c_.add_shape(item.name + "::wall", wall, *housing, mass, c_.snares[item.name].wires);
    for (const int w : c_.snares[item.name].wires) {
      if (may_press)
        c_.wires[at(w)].wall = {housing->X_WF.p, inner, inner + thickness, length, wall.foundation};
    }
    c_.drawn.push_back({item.name + "::wall", housing->carrier, housing->X_WF, wall.shape->drawing()});
  }
}

}  // namespace snare::scenario
