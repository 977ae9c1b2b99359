#include "scenario/list_items.hpp"

#include "base/index.hpp"
#include "base/units.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "scenario/law_wire_reader.hpp"
#include "scenario/motion_reader.hpp"
#include "scenario/push_reader.hpp"
#include "scenario/shape_reader.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::scenario {

using base::Choice;
using base::mm;
using base::Range;
using base::TomlTable;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double far = farthest_mm;

coupling::WireTightness read_tightness(const TomlTable& table) {
  coupling::WireTightness t;
  t.watched = true;
  if (table.has("tight_N"))
    t.tension = table.number("tight_N", Range::above(0.0, 1e9));
  else if (table.has("tight_hold_s"))
    table.fail("tight_hold_s", "only beside tight_N");
  t.hold = table.number_or("tight_hold_s", t.hold, Range::from(0.0, 1e3));
  return t;
}

}  // namespace

multibody::Pose read_pose_in_frame(const TomlTable& table) {
  multibody::Pose X;
  X.p = read_vector_or_zero(table, "position_mm", Range::from(-far, far), mm);
  X.R = read_rotation_vector(table, "rotation_deg");
  if (!table.has("rpy_deg")) return X;
  if (table.has("rotation_deg")) table.fail("rpy_deg", "cannot stand beside rotation_deg");
  X.R = read_roll_pitch_yaw(table, "rpy_deg");
  return X;
}

DeclaredWire read_wire_item(const TomlTable& table, const wire::RodDamping& damping,
                            wire::SpatialEnd::Kind mount, const std::optional<BesideScenario>& beside,
                            std::optional<double> natural_length) {
  DeclaredWire w;
  w.specification = read_wire(table, Held::at_its_ends, natural_length);
  for (const char* key : {"yield_stress_MPa", "natural_curvature_1_m"}) {
    if (table.has(key)) table.fail(key, "the wire is elastic and naturally straight in motion");
  }
  w.mounts = read_mounts(table, mount);
  w.wire.rod.elements = table.integer_or("elements", 40, 8, 20000);
  w.wire.rod.formulation = read_formulation(table);
  const WireStandIn stand_in = read_wire_stand_in(table, w.specification, damping, beside);
  w.wire.rod.quasi_static = stand_in.quasi_static;
  w.law = stand_in.law;
  w.push = stand_in.push;
  if (w.law && w.mounts.give_way())
    table.table("mount").fail(
        "", "a law stands for the wire and for what its mounts give: only \"kind\" is allowed");
  // Of a round wire it is EI/(1 + nu), of strands that slide not much less. A wire that turns about itself as
  // it likes swings about its chord without a force: it has no equilibrium that could be followed.
  constexpr double least_share = 1e-3;
  if (w.wire.rod.quasi_static &&
      w.specification.torsional_stiffness() < least_share * w.specification.bending_stiffness())
    table.fail(
        table.has("torsional_stiffness_Nm2") ? "torsional_stiffness_Nm2" : "bending_stiffness_Nm2",
        fmt::format(
            "must leave a quasi-static wire a torsional stiffness of at least {:g} of its bending stiffness",
            least_share));
  w.wire.rod.damping = damping;
  w.mounts.set(w.wire.rod.properties);
  w.wire.strength = read_strength(table, w.specification);
  w.wire.tightness = read_tightness(table);
  return w;
}

void set_rod(DeclaredWire& w, double span) {
  wire::RodInMotion rod = wire::rod_in_motion(w.specification, span, w.wire.rod.elements);
  rod.formulation = w.wire.rod.formulation;
  rod.quasi_static = w.wire.rod.quasi_static;
  rod.damping = w.wire.rod.damping;
  rod.strands.time = w.wire.rod.strands.time;
  for (const wire::End which : wire::ends) {
    wire::SpatialEnd& end = rod.properties.end(which);
    const wire::SpatialEnd& declared = w.wire.rod.properties.end(which);
    end.kind = declared.kind;
    end.rotational_stiffness = declared.rotational_stiffness;
    end.translational_stiffness = declared.translational_stiffness;
  }
  w.wire.rod = rod;
}

void stretch(DeclaredWire& w, const TomlTable& table, const std::string& to_key,
             const std::string& bulge_key) {
  w.span = (w.to - w.from).norm();
  if (!(w.span > 0.0)) table.fail(to_key, "must not be where the wire begins");
  check_wire_between_mounts(w.specification, w.span, table);
  const Vector3d across = w.bulge - w.bulge.dot(w.to - w.from) / (w.span * w.span) * (w.to - w.from);
  if (across.norm() < 1e-3 * w.bulge.norm() || w.bulge.norm() == 0.0)
    table.fail(bulge_key, "must have a bulge, a direction across the chord");
  else
    w.bulge = across.normalized();
  set_rod(w, w.span);
  if (!w.law || w.law->kind != coupling::LawWire::Kind::push) return;
  if (w.from_carrier != w.to_carrier)
    table.fail(
        "model",
        fmt::format("must not be \"{}\" of a wire whose mounts move against each other: the law was taken "
                    "between mounts that stand still",
                    table.text("model")));
  else if (w.push && w.span > 0.0)
    check_push_model(*w.push, w.wire.rod, w.span, table);
}

coupling::LawWire law_in_place(const DeclaredWire& w) {
  coupling::LawWire law = *w.law;
  law.name = w.wire.name;
  law.from = w.from_carrier;
  law.to = w.to_carrier;
  law.p_from = w.from;
  law.p_to = w.to;
  law.bulge = w.bulge;
  law.strength = w.wire.strength;
  law.tightness = w.wire.tightness;
  return law;
}

// The wire of its own frame (chord along x, bulge to y) turned to where its mounts are.
coupling::MotionWire at_rest(DeclaredWire w, const Eigen::Matrix3Xd* shape) {
  const Matrix3d rest_frame =
      (Matrix3d() << (w.to - w.from) / w.span, w.bulge, (w.to - w.from).cross(w.bulge) / w.span).finished();
  const Eigen::Matrix3Xd rest = shape != nullptr ? *shape : coupling::resting_wire(w.wire.rod);
  w.wire.positions = (rest_frame * rest).colwise() + w.from;
  for (const wire::End which : wire::ends) {
    wire::SpatialEnd& end = w.wire.rod.properties.end(which);
    end.position = rest_frame * end.position + w.from;
    end.direction = rest_frame * end.direction;
    end.director = rest_frame * end.director;
    // A mount that gives holds the end as a part of the motion; the wire's own spring was that of the shape
    // at rest.
    const Eigen::Index vertex = which == wire::End::left ? 0 : w.wire.positions.cols() - 1;
    if (!end.gives()) w.wire.positions.col(vertex) = end.position;
    end.translational_stiffness = std::numeric_limits<double>::infinity();
  }
  return w.wire;
}

DeclaredBody read_body(const TomlTable& table) {
  DeclaredBody declared;
  coupling::MotionBody& body = declared.body;
  body.driven = table.boolean_or("driven", false);
  if (body.driven) {
    for (const char* key :
         {"mass_kg", "inertia_kg_m2", "com_mm", "spin_rad_s", "drag_Ns_m", "drag_Nms_rad", "force_N"}) {
      if (table.has(key)) table.fail(key, "a driven body moves at a constant velocity_m_s whatever it meets");
    }
    static_cast<void>(table.has("robot"));  // of a composed scenario, which reads it behind the contacts
  } else {
    body.properties = read_body_properties(table);
    body.start.spin = read_vector_or_zero(table, "spin_rad_s", Range::from(-1e3, 1e3), 1.0);
    declared.com = read_vector_or_zero(table, "com_mm", Range::from(-far, far), mm);
    body.linear_drag = table.number_or("drag_Ns_m", 0.0, Range::from(0.0, 1e6));
    body.angular_drag = table.number_or("drag_Nms_rad", 0.0, Range::from(0.0, 1e6));
    body.force = read_vector_or_zero(table, "force_N", Range::from(-1e9, 1e9), 1.0);
  }
  const multibody::Pose X = read_pose_in_frame(table);
  body.start.position = X.p + X.R * declared.com;
  body.start.orientation = Eigen::Quaterniond(X.R);
  body.start.velocity = read_vector_or_zero(table, "velocity_m_s", Range::from(-1e3, 1e3), 1.0) +
                        X.R * body.start.spin.cross(declared.com);
  return declared;
}

coupling::MotionContact read_contact_shape(const TomlTable& table, const std::filesystem::path& folder,
                                           std::string& meshes) {
  coupling::MotionContact contact;
  contact.shape = read_shape(table, folder, meshes);
  contact.X_BS = read_pose_in_frame(table);
  contact.friction =
      read_friction(table, table.number_or("friction", 0.0, Range::from(0.0, 5.0)), "friction");
  contact.foundation = read_foundation(table.table("foundation"));
  static_cast<void>(
      table.integer_or("points", 4, 1, 100));  // of older files: their number has no limit any more
  return contact;
}

coupling::WirePair read_pair_law(const TomlTable& table) {
  coupling::WirePair pair;
  pair.friction = read_friction(table, table.number_or("friction", 0.0, Range::from(0.0, 5.0)), "friction");
  pair.foundation = read_foundation(table.table("foundation"));
  return pair;
}

coupling::WirePair read_wire_pair(const TomlTable& table, const Names& wires,
                                  const std::vector<DeclaredWire>& declared) {
  coupling::WirePair pair = read_pair_law(table);
  static constexpr const char* keys[] = {"wire", "other_wire"};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string name = table.text(keys[k]);
    const std::optional<int> index = wires.find(name);
    if (!index && !name.empty()) table.fail(keys[k], wires.requirement());
    pair.wires[k] = index.value_or(static_cast<int>(k));
    if (index) pair.radii[k] = 0.5 * declared[base::at(*index)].specification.diameter;
  }
  if (pair.wires[0] == pair.wires[1])
    table.fail("other_wire", "must not be the wire itself: contact of a wire with itself is not computed");
  return pair;
}

std::vector<int> wires_met(const TomlTable& table, const Names& wires, std::size_t count) {
  std::vector<int> met;
  if (!table.has("wires")) {
    for (std::size_t k = 0; k < count; ++k) met.push_back(static_cast<int>(k));
    return met;
  }
  const std::vector<std::string> names = table.texts_or_none("wires");
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (const std::optional<int> index = wires.find(names[k]))
      met.push_back(*index);
    else
      table.fail_element("wires", k, wires.requirement());
  }
  return met;
}

}  // namespace snare::scenario
