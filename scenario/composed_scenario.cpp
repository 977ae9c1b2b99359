#include "scenario/composed_scenario.hpp"

#include "base/errors.hpp"
#include "base/index.hpp"
#include "base/units.hpp"
#include "scenario/arm_items.hpp"
#include "scenario/body_contact_reader.hpp"
#include "scenario/capture_reader.hpp"
#include "scenario/composition.hpp"
#include "scenario/drive_reader.hpp"
#include "scenario/housing_wall.hpp"
#include "scenario/law_wire_reader.hpp"
#include "scenario/listed_wire.hpp"
#include "scenario/load_reader.hpp"
#include "scenario/motion_reader.hpp"
#include "scenario/phase_reader.hpp"
#include "scenario/robot_reader.hpp"
#include "scenario/sensor_reader.hpp"
#include "scenario/snare_items.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace snare::scenario {

using base::at;
using base::Range;
using base::TomlDocument;
using base::TomlTable;
using coupling::MotionCarrier;
using Eigen::Vector3d;
using multibody::Pose;

namespace {

constexpr double light = 0.1;  // [kg], of what a shape on an arm weighs where the file does not say

void read_bodies(Composition& c) {
  for (const TomlTable& table : c.document.root().tables("bodies")) {
    const int index = static_cast<int>(c.motion.bodies.size());
    const std::string name = c.body_names.take(table);
    DeclaredBody declared = read_body(table);
    c.motion.bodies.push_back(std::move(declared.body));
    c.motion.bodies.back().name = name;
    const Pose X_CB{Eigen::Matrix3d::Identity(),
                    -declared.com};  // of the body's frame in that of its centre of mass
    c.placement.stand(table, "frame", name,
                      [&c, index, name, X_CB](const PlacedFrame& on, Placement& placement) {
                        multibody::RigidBodyState& start = c.motion.bodies[at(index)].start;
                        const Pose X_WC = on.X_WF * pose_of(start);
                        start.position = X_WC.p;
                        start.orientation = Eigen::Quaterniond(X_WC.R);
                        start.velocity = on.X_WF.R * start.velocity;
                        placement.add(name, {{MotionCarrier::Kind::body, index, 0}, X_WC * X_CB});
                      });
  }
}

void read_frames(Composition& c) {
  Names names("frame");
  for (const TomlTable& table : c.document.root().tables("frames")) {
    const std::string name = names.take(table);
    if (c.body_names.find(name) || c.arm_names.find(name) || name == "world")
      table.fail("name", "is taken by a body, an arm or a snare");
    const Pose X_FF = read_pose_in_frame(table);
    c.placement.stand(table, "frame", name, [name, X_FF](const PlacedFrame& on, Placement& placement) {
      placement.add(name, {on.carrier, on.X_WF * X_FF});
    });
  }
}

void read_wires(Composition& c) {
  for (const TomlTable& table : c.document.root().tables("wires")) {
    c.wires.push_back(read_listed_wire(table, c.wire_names, c.placement, c.damping, {c.folder, c.input}));
    c.model_keys.push_back(table.address() + ".model");
    for (std::string& model : models_with_numbers(table)) c.law_models.insert(std::move(model));
  }
}

/// Adds a warning where a mesh is so small or so large that its unit is more likely the other one.
void doubt_size(Composition& c, const std::string& name, const std::string& unit,
                const coupling::ContactShape& shape) {
  constexpr double smallest = 0.5 * base::mm,
                   largest = 500.0;  // a body that a wire of a millimetre holds, and one of this world [m]
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Matrix3Xd& line : shape.drawing()) {
    low = low.cwiseMin(line.rowwise().minCoeff());
    high = high.cwiseMax(line.rowwise().maxCoeff());
  }
  const double size = (high - low).maxCoeff();
  if (unit == "mm" && size < smallest)
    c.warnings.push_back(
        fmt::format("shape {}: its mesh is only {:.3g} mm large: is the file in metres (unit = \"m\")?", name,
                    size / base::mm));
  if (unit == "m" && size > largest)
    c.warnings.push_back(fmt::format(
        "shape {}: its mesh is {:.3g} m large: is the file in millimetres (unit = \"mm\")?", name, size));
}

void read_shapes(Composition& c) {
  for (const TomlTable& table : c.document.root().tables("shapes")) {
    const std::string name = c.shape_names.take(table);
    const coupling::MotionContact shape = read_contact_shape(table, c.folder, c.input);
    const char* key = table.has("body") ? "body" : "frame";
    if (table.has("body") && table.has("frame"))
      table.fail("frame", "cannot stand beside body, which means the same");
    const std::optional<PlacedFrame> frame = c.placement.frame(table, key);
    const double mass = table.number_or("mass_kg", light, Range::above(0.0, 1e7));
    const std::vector<int> on = wires_met(table, c.wire_names, c.wires.size());
    if (!frame) continue;
    c.add_shape(name, shape, *frame, mass, on);
    const PlacedShape placed{table, {frame->carrier, frame->X_WF * shape.X_BS}, shape.shape};
    c.shapes.try_emplace(name, placed);
    if (shape.shape && table.has("unit")) doubt_size(c, name, table.text("unit"), *shape.shape);
    set_shaft(c, name, placed, shape.friction, on);
    if (shape.shape) c.drawn.push_back({name, placed.on.carrier, placed.on.X_WF, shape.shape->drawing()});
  }
  require_shafts(c);
}

void read_contacts(Composition& c) {
  std::set<std::pair<int, int>> met;
  for (const coupling::WirePair& p : c.motion.wire_pairs) met.insert(std::minmax(p.wires[0], p.wires[1]));
  for (const TomlTable& table : c.document.root().tables("contacts")) {
    const std::string name = c.pair_names.take(table);
    if (table.has("shape") || table.has("other_shape")) {
      read_body_contact(c, table, name);
      continue;
    }
    coupling::WirePair pair = read_wire_pair(table, c.wire_names, c.wires);
    pair.name = name;
    if (c.wires.size() > 1 && (c.wires[at(pair.wires[0])].law || c.wires[at(pair.wires[1])].law)) continue;
    for (int& wire : pair.wires) wire = c.wires.size() > 1 ? c.counted(wire) : wire;
    if (!met.insert(std::minmax(pair.wires[0], pair.wires[1])).second)
      table.fail("other_wire", "is already in contact with this wire");
    c.motion.wire_pairs.push_back(pair);
  }
}

/// Three numbers, or one for all.
Vector3d along_axes(const TomlTable& table, std::string_view key, bool required) {
  const Range range = Range::from(0.0, 1e15);
  if (!table.has(key) && !required) return Vector3d::Zero();
  const std::vector<double> v = table.numbers_or_one(key, 3, range);
  return v.size() == 3 ? Vector3d(v[0], v[1], v[2]) : Vector3d::Zero();
}

void read_bushings(Composition& c) {
  Names names("bushing");
  for (const TomlTable& table : c.document.root().tables("bushings")) {
    coupling::MotionBushing b;
    b.name = names.take(table);
    const PlacedFrame on = c.placement.frame(table, "frame").value_or(PlacedFrame{});
    const PlacedFrame other = c.placement.frame(table, "other_frame").value_or(PlacedFrame{});
    b.first = on.carrier;
    b.second = other.carrier;
    b.X_WF = on.X_WF;
    static constexpr base::Choice<bool> neutrals[] = {{"start", false}, {"frames", true}};
    if (table.has("neutral") && table.choice("neutral", neutrals).value_or(false)) b.X_WG = other.X_WF;
    if (table.text_or("frame", "world") == table.text_or("other_frame", "world"))
      table.fail("other_frame", "must be another frame");
    b.translational_stiffness = along_axes(table, "translational_stiffness_N_m", true);
    b.rotational_stiffness = along_axes(table, "rotational_stiffness_Nm_rad", true);
    b.translational_damping = along_axes(table, "translational_damping_Ns_m", false);
    b.rotational_damping = along_axes(table, "rotational_damping_Nms_rad", false);
    c.motion.bushings.push_back(b);
  }
}

void read_welds(Composition& c) {
  Names names("weld");
  std::set<int> held;
  for (const TomlTable& table : c.document.root().tables("welds")) {
    coupling::MotionWeld weld;
    weld.name = names.take(table);
    const std::string body = table.text("body");
    const std::optional<int> index = c.body_names.find(body);
    if (!index && !body.empty()) table.fail("body", c.body_names.requirement());
    const std::optional<PlacedFrame> on = c.placement.frame(table, "frame");
    if (!index || !on) continue;
    weld.body = *index;
    weld.carrier = on->carrier;
    if (c.motion.bodies[at(*index)].driven)
      table.fail("body", "is driven: it moves as told, whatever holds it");
    if (!held.insert(*index).second)
      table.fail("body", "is welded already: two welds would hold six freedoms twice");
    if (weld.carrier.kind == MotionCarrier::Kind::body && weld.carrier.index == *index)
      table.fail("frame", "must not be on the body itself");
    c.motion.welds.push_back(weld);
  }
}

/// Carriers before what they hold; what holds itself by way of others is reported.
void order_welds(Composition& c) {
  std::vector<coupling::MotionWeld>& welds = c.motion.welds;
  std::vector<coupling::MotionWeld> ordered;
  std::set<int> waiting;
  for (const coupling::MotionWeld& w : welds) waiting.insert(w.body);
  for (bool progress = true; progress;) {
    progress = false;
    for (auto w = welds.begin(); w != welds.end();) {
      if (w->carrier.kind == MotionCarrier::Kind::body && waiting.contains(w->carrier.index)) {
        ++w;
        continue;
      }
      waiting.erase(w->body);
      ordered.push_back(*w);
      w = welds.erase(w);
      progress = true;
    }
  }
  if (!welds.empty()) c.document.root().fail("welds", "must not hold each other in a circle");
  welds = std::move(ordered);
}

/// Ends of wires on what moves, or that give.
void add_mounts(Composition& c) {
  bool leave_the_world = false;
  for (std::size_t w = 0; w < c.wires.size(); ++w) {
    const std::pair<wire::End, const MotionCarrier*> ends[] = {{wire::End::left, &c.wires[w].from_carrier},
                                                               {wire::End::right, &c.wires[w].to_carrier}};
    if (c.wires[w].law) continue;
    for (const auto& [end, carrier] : ends) {
      const coupling::MountGive& give = c.wires[w].mounts.give[index_of(end)];
      const bool moves = carrier->kind != MotionCarrier::Kind::world;
      if (!moves && !give.gives()) continue;
      leave_the_world = leave_the_world || moves;
      coupling::MotionMount mount;
      mount.name = c.wires[w].wire.name + (end == wire::End::left ? " left mount" : " right mount");
      mount.wire = c.counted(static_cast<int>(w));
      mount.end = end;
      mount.carrier = *carrier;
      mount.give = give;
      c.motion.mounts.push_back(mount);
    }
  }
  if (leave_the_world && c.damping.mass_rate > 0.0)
    c.document.root().table("damping").fail(
        "mass_rate_1_s",
        "must be 0: it drags against the world, which wires on arms, bodies and snares leave");
}

/// Refuses a shaft that has pushed the wire at the start: it has no side to which it belongs.
void require_before(const coupling::LawWire& wire) {
  const Vector3d chord = (wire.p_to - wire.p_from).normalized(), push = wire.side * wire.bulge;
  const Vector3d across = chord.cross(push), axis = wire.shaft.X_WS.R.col(2);
  const double along = across.dot(wire.p_from - wire.shaft.X_WS.p) / across.dot(axis);
  if (!(std::abs(along) <= wire.shaft.half_length)) return;  // it does not go through the plane of the wire
  const Vector3d place = wire.shaft.X_WS.p + along * axis - wire.p_from;
  const double depth = wire.push({chord.dot(place), push.dot(place)}, 0.0).depth;
  const bool beside = chord.dot(place) <= 0.0 || chord.dot(place) >= (wire.p_to - wire.p_from).norm();
  constexpr double rounding = 1e-6;  // of places in a file [m]
  if (!beside && depth > rounding)
    throw base::InputError({"", 0, fmt::format("{} on {}.gap", wire.shaft.name, wire.name),
                            fmt::format("{}", -depth), "must be >= 0 m at the start"});
}

/// Laws of pushes know their wire at rest. One may be without force over the first part of its travel: steps
/// are limited to a tenth of a millimetre at the speed of the start, so that none leaps over the rest.
void complete_pushes(Composition& c, coupling::MotionOptions& options) {
  std::size_t next = 0;
  for (const DeclaredWire& w : c.wires) {
    if (!w.law) continue;
    coupling::LawWire& law = c.motion.law_wires[next++];
    if (!w.push) continue;
    set_push_law(*w.push, w.wire.rod, law);
    require_before(law);
    if (law.shaft.carrier.kind != MotionCarrier::Kind::body) continue;
    const multibody::RigidBodyState& start = c.motion.bodies[at(law.shaft.carrier.index)].start;
    const double speed =
        start.velocity.norm() + start.spin.norm() * (law.shaft.X_WS.p - start.position).norm();
    constexpr double resolved_travel = 1e-4;  // [m]
    if (w.push->law && speed > 0.0) options.max_step = std::min(options.max_step, resolved_travel / speed);
  }
}

}  // namespace

ArmOverrides take_arm_overrides(std::vector<base::Override>& overrides) {
  constexpr std::string_view list = "arms[";
  ArmOverrides arms;
  std::vector<base::Override> own;
  for (base::Override& one : overrides) {
    const std::size_t end = one.key.find("].");
    if (one.key.starts_with(list) && end != std::string::npos) {
      const std::string rest = one.key.substr(end + 2);
      const std::string_view first = std::string_view(rest).substr(0, rest.find_first_of(".["));
      if (first == "joint" || first == "every_joint" || first == "link" || first == "gravity_m_s2") {
        arms[one.key.substr(list.size(), end - list.size())].push_back({rest, one.value});
        continue;
      }
    }
    own.push_back(std::move(one));
  }
  overrides = std::move(own);
  return arms;
}

WireMotions read_composition(TomlDocument& document, const std::filesystem::path& folder,
                             const ArmOverrides& arms, WireMesh mesh) {
  const TomlTable root = document.root();
  NamedMotion run;
  run.name = root.text("title");
  run.model = "wire";
  Composition c{document, folder, arms};
  static_cast<void>(root.has("include"));  // what it lists has been put in its place
  read_motion_options(root, run.options);
  c.motion.gravity = read_vector_or_zero(root.table("gravity"), "vector_m_s2", Range::from(-1e3, 1e3), 1.0);
  c.damping = read_damping(root.table("damping"));
  c.strand_time = root.table("damping").number_or("strand_time_s", c.strand_time, Range::from(1e-9, 1.0));
  // What stands somewhere, then what is between.
  read_arms(c);
  for (const auto& [name, of_file] : arms) {
    if (!c.arm_names.find(name))
      document.add({"--set", 0, fmt::format("arms[{}].{}", name, of_file.front().key), of_file.front().value,
                    "no such arm: " + c.arm_names.requirement()});
  }
  read_bodies(c);
  Snares snares(c);
  read_frames(c);
  c.placement.resolve();
  read_wires(c);
  snares.add_wires();
  read_shapes(c);
  snares.add_walls();
  for (const DeclaredWire& w : c.wires)
    if (w.law) c.motion.law_wires.push_back(law_in_place(w));  // before what asks for contacts by name
  read_contacts(c);
  read_bushings(c);
  read_loads(c);
  read_welds(c);
  order_welds(c);
  read_robots(c);
  read_drives(c);
  WireMotions motions;
  motions.sensors = read_sensors(c, run.options.output_interval);
  read_phases(c, motions.sensors);
  add_mounts(c);
  if (c.motion.arms.empty() && c.motion.bodies.empty() && c.wires.empty())
    root.fail("", "must list something that moves: [[arms]], [[bodies]], [[snares]] or [[wires]]");
  const TomlTable output = root.table("output");
  motions.output = read_motion_output(output, run.options);
  motions.output.modes = output.boolean_or("modes", false);
  if (output.has("swings")) {
    if (const MotorJoint* joint = c.joint(output, "swings"))
      motions.swinging.emplace(joint->arm, joint->joint);
  }
  motions.capture = read_capture(c);
  motions.input = c.input + document.canonical(least_advance_key);
  motions.duration = run.options.duration;
  document.finish();
  complete_pushes(c, run.options);
  for (DeclaredWire& w : c.wires) {
    w.wire.rod.strands.time = c.strand_time;
    if (mesh == WireMesh::halved) w.wire.rod.elements = (w.wire.rod.elements + 1) / 2;
  }
  PressedRests pressed;
  for (DeclaredWire& w : c.wires) {
    if (w.law) continue;
    if (w.line)
      c.motion.wires.push_back(on_line(std::move(w)));
    else
      c.motion.wires.push_back(w.wall ? at_rest_in_wall(std::move(w), pressed) : at_rest(std::move(w)));
  }
  motions.model_keys = std::move(c.model_keys);
  motions.law_models.assign(c.law_models.begin(), c.law_models.end());
  motions.drawn = std::move(c.drawn);
  run.motion = std::move(c.motion);
  run.warnings = std::move(c.warnings);
  motions.runs.push_back(std::move(run));
  return motions;
}

}  // namespace snare::scenario
