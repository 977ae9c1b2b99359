#include "scenario/bodies_scenario.hpp"

#include "base/index.hpp"
#include "base/toml_reader.hpp"
#include "base/units.hpp"
#include "coupling/dynamics/start.hpp"
#include "scenario/motion_reader.hpp"
#include "scenario/push_reader.hpp"
#include "scenario/shape_reader.hpp"
#include "wire/rod_constants.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <set>

namespace snare::scenario {

using base::Choice;
using base::Range;
using base::TomlDocument;
using base::TomlTable;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using base::mm;
constexpr double far = farthest_mm;

/// Names of one kind, each once.
class Names {
 public:
  explicit Names(std::string what) : what_(std::move(what)) {}
  std::string take(const TomlTable& table) {
    std::string name = table.text("name");
    if (!index_.try_emplace(name, static_cast<int>(index_.size())).second)
      table.fail("name", fmt::format("is taken by another {}", what_));
    list_ += fmt::format("{}\"{}\"", list_.empty() ? "" : ", ", name);
    return name;
  }
  [[nodiscard]] std::optional<int> find(const std::string& name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? std::nullopt : std::optional(found->second);
  }
  [[nodiscard]] std::string requirement() const { return fmt::format("must be the name of a {}: {}", what_, list_); }

 private:
  std::string what_, list_;
  std::map<std::string, int> index_;
};

/// A wire as it stands in the file; its shape at rest is found when all of the file is known to be right.
struct DeclaredWire {
  wire::WireSpecification specification;
  coupling::MotionWire wire;
  Vector3d from = Vector3d::Zero(), to = Vector3d::UnitX(), bulge = Vector3d::UnitY();
  double span = 0.0;
};

DeclaredWire read_declared_wire(const TomlTable& table, Names& names, const wire::RodDamping& damping) {
  DeclaredWire w;
  w.wire.name = names.take(table);
  w.specification = read_wire(table);
  for (const char* key : {"strand_extra_stiffness_Nm2", "yield_stress_MPa", "natural_curvature_1_m"}) {
    if (table.has(key)) table.fail(key, "the wire is elastic and naturally straight in motion");
  }
  static constexpr Choice<wire::SpatialEnd::Kind> mounts[] = {{"clamped", wire::SpatialEnd::Kind::clamp},
                                                              {"pinned", wire::SpatialEnd::Kind::twisting_pin}};
  const auto kind = table.has("mount") ? table.choice("mount", mounts) : wire::SpatialEnd::Kind::clamp;
  w.from = read_vector(table, "from_mm", Range::from(-far, far), mm).value_or(w.from);
  w.to = read_vector(table, "to_mm", Range::from(-far, far), mm).value_or(w.to);
  w.span = (w.to - w.from).norm();
  if (!(w.span > 0.0)) table.fail("to_mm", "must not be from_mm");
  check_wire_between_mounts(w.specification, w.span, table);
  if (const auto bulge = table.has("bulge") ? read_vector(table, "bulge", Range::from(-1e3, 1e3), 1.0) : std::nullopt) {
    w.bulge = *bulge;
  }
  const Vector3d across = w.bulge - w.bulge.dot(w.to - w.from) / (w.span * w.span) * (w.to - w.from);
  if (across.norm() < 1e-3 * w.bulge.norm() || w.bulge.norm() == 0.0)
    table.fail(table.has("bulge") ? "bulge" : "", "must have a bulge, a direction across the chord");
  else
    w.bulge = across.normalized();
  w.wire.rod = wire::rod_in_motion(w.specification, w.span, table.integer_or("elements", 60, 8, 20000));
  w.wire.rod.formulation = read_formulation(table);
  w.wire.rod.quasi_static = read_quasi_static(table);
  w.wire.rod.damping = damping;
  w.wire.strength = read_strength(table, w.specification);
  w.wire.rod.properties.left.kind = w.wire.rod.properties.right.kind = kind.value_or(wire::SpatialEnd::Kind::clamp);
  return w;
}

// The wire of its own frame (chord along x, bulge to y) turned to where its mounts are.
coupling::MotionWire place(DeclaredWire w) {
  const Matrix3d rest_frame =
      (Matrix3d() << (w.to - w.from) / w.span, w.bulge, (w.to - w.from).cross(w.bulge) / w.span).finished();
  const Eigen::Matrix3Xd rest = coupling::resting_wire(w.wire.rod);
  w.wire.positions = (rest_frame * rest).colwise() + w.from;
  for (auto* end : {&w.wire.rod.properties.left, &w.wire.rod.properties.right}) {
    end->position = rest_frame * end->position + w.from;
    end->direction = rest_frame * end->direction;
    end->director = rest_frame * end->director;
  }
  w.wire.positions.col(0) = w.wire.rod.properties.left.position;
  w.wire.positions.rightCols<1>() = w.wire.rod.properties.right.position;
  return w.wire;
}

coupling::MotionBody read_body(const TomlTable& table, Names& names) {
  coupling::MotionBody body;
  body.name = names.take(table);
  body.driven = table.boolean_or("driven", false);
  if (body.driven) {
    for (const char* key : {"mass_kg", "inertia_kg_m2", "spin_rad_s", "drag_Ns_m", "drag_Nms_rad", "force_N"}) {
      if (table.has(key)) table.fail(key, "a driven body moves at a constant velocity_m_s whatever it meets");
    }
  } else {
    body.properties = read_body_properties(table);
    body.start.spin = read_vector_or_zero(table, "spin_rad_s", Range::from(-1e3, 1e3), 1.0);
    body.linear_drag = table.number_or("drag_Ns_m", 0.0, Range::from(0.0, 1e6));
    body.angular_drag = table.number_or("drag_Nms_rad", 0.0, Range::from(0.0, 1e6));
    body.force = read_vector_or_zero(table, "force_N", Range::from(-1e9, 1e9), 1.0);
  }
  body.start.position = read_vector_or_zero(table, "position_mm", Range::from(-far, far), mm);
  body.start.orientation = Eigen::Quaterniond(read_rotation_vector(table, "rotation_deg"));
  body.start.velocity = read_vector_or_zero(table, "velocity_m_s", Range::from(-1e3, 1e3), 1.0);
  return body;
}

/// A shape with its body and friction, on no wire yet.
coupling::MotionContact read_contact_shape(const TomlTable& table, const std::filesystem::path& folder,
                                           const Names& bodies, std::string& meshes) {
  coupling::MotionContact contact;
  contact.shape = read_shape(table, folder, meshes);
  const std::string body = table.text("body");
  const std::optional<int> of_body = bodies.find(body);
  if (!of_body && !body.empty()) table.fail("body", bodies.requirement());
  contact.body = of_body.value_or(0);
  contact.X_BS.p = read_vector_or_zero(table, "position_mm", Range::from(-far, far), mm);
  contact.X_BS.R = read_rotation_vector(table, "rotation_deg");
  contact.friction = read_friction(table, table.number_or("friction", 0.0, Range::from(0.0, 5.0)), "friction");
  contact.foundation = read_foundation(table.table("foundation"));
  static_cast<void>(table.integer_or("points", 4, 1, 100));  // of older files: their number has no limit any more
  return contact;
}

/// Indices of the wires that a shape may touch: those it names, or all.
std::vector<int> wires_met(const TomlTable& table, const Names& wires, const std::vector<DeclaredWire>& declared) {
  std::vector<std::string> names = table.texts_or_none("wires");
  if (!table.has("wires")) {
    for (const DeclaredWire& w : declared) names.push_back(w.wire.name);
  }
  std::vector<int> met;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (const std::optional<int> index = wires.find(names[k]))
      met.push_back(*index);
    else
      table.fail_element("wires", k, wires.requirement());
  }
  return met;
}

}  // namespace

WireMotions read_bodies(TomlDocument& document, const std::filesystem::path& folder) {
  const TomlTable root = document.root();
  NamedMotion run;
  run.name = root.text("title");
  run.model = "wire";
  coupling::Motion& motion = run.motion;
  std::string meshes;  // their fingerprints
  read_motion_options(root, run.options);
  for (const char* key : {"body", "wire", "mount", "pusher", "models"}) {
    if (root.has(key)) root.fail(key, "not beside lists of bodies, wires and shapes");
  }
  const TomlTable gravity = root.table("gravity");
  motion.gravity = read_vector_or_zero(gravity, "vector_m_s2", Range::from(-1e3, 1e3), 1.0);
  const wire::RodDamping damping = read_damping(root.table("damping"));

  Names wires("wire"), bodies("body"), shapes("shape");
  std::vector<DeclaredWire> declared;
  for (const TomlTable& table : root.tables("wires")) declared.push_back(read_declared_wire(table, wires, damping));
  for (const TomlTable& table : root.tables("bodies")) motion.bodies.push_back(read_body(table, bodies));
  for (const std::string_view key : list_keys) {
    if (!root.has(key)) root.fail(key, "must be given, one table or more");
  }
  for (const TomlTable& table : root.tables("shapes")) {
    const std::string name = shapes.take(table);
    const coupling::MotionContact shape = read_contact_shape(table, folder, bodies, meshes);
    for (const int wire : wires_met(table, wires, declared)) {
      const DeclaredWire& met = declared[base::at(wire)];
      motion.contacts.push_back(shape);
      motion.contacts.back().wire = wire;
      motion.contacts.back().name = fmt::format("{} on {}", name, met.wire.name);
      motion.contacts.back().wire_radius = 0.5 * met.specification.diameter;
    }
  }
  WireMotions motions;
  motions.output = read_motion_output(root.table("output"), run.options);
  motions.input = meshes + document.canonical();
  motions.duration = run.options.duration;
  document.finish();
  for (DeclaredWire& w : declared) motion.wires.push_back(place(std::move(w)));
  motions.runs.push_back(std::move(run));
  return motions;
}

}  // namespace snare::scenario
