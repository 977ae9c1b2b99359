#include "scenario/contact_scenario.hpp"

#include "base/plain_name.hpp"
#include "base/toml_reader.hpp"
#include "base/units.hpp"
#include "coupling/dynamics/start.hpp"
#include "scenario/contact_law_reader.hpp"
#include "scenario/motion_reader.hpp"
#include "scenario/push_reader.hpp"
#include "wire/rod_constants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace snare::scenario {

using base::Choice;
using base::Range;
using base::TomlDocument;
using base::TomlTable;
using Eigen::Vector3d;

namespace {

using base::mm;

/// What stands for the wire: itself, or a law.
struct Asked {
  bool quasi_static = false;
  std::optional<LawModel> law = {};
};

WireModel read_model(const TomlTable& table) {
  static constexpr Choice<Asked> kinds[] = {{"wire", {}},
                                            {"quasi_static", {true}},
                                            {"spring_dashpot", {false, LawModel::spring_dashpot}},
                                            {"power", {false, LawModel::power}},
                                            {"step_damped", {false, LawModel::step_damped}},
                                            {"quadratic", {false, LawModel::quadratic}},
                                            {"stretched_wire", {false, LawModel::stretched_wire}},
                                            {"stretched_wire_linear", {false, LawModel::stretched_wire_linear}}};
  WireModel model;
  model.name = table.text("name");
  base::require_plain_name(table, "name", model.name);
  model.kind = table.text("model");
  const std::optional<Asked> asked = table.choice("model", kinds);
  if (!asked) return model;
  model.quasi_static = asked->quasi_static;
  if (asked->law) model.law = read_contact_law(table, *asked->law);
  return model;
}

void read_body(const TomlTable& table, ContactScenario& scenario) {
  coupling::MotionBody& body = scenario.body;
  body.name = table.text_or("name", "body");
  base::require_plain_name(table, "name", body.name);
  body.properties = read_body_properties(table);
  scenario.probe = read_vector_or_zero(table, "probe_mm", Range::from(-farthest_mm, farthest_mm), mm);
  body.start.velocity = read_vector_or_zero(table, "velocity_m_s", Range::from(-1e3, 1e3), 1.0);
  body.start.spin = read_vector_or_zero(table, "spin_rad_s", Range::from(-1e3, 1e3), 1.0);
  body.linear_drag = table.number_or("drag_Ns_m", 0.0, Range::from(0.0, 1e6));
  body.angular_drag = table.number_or("drag_Nms_rad", 0.0, Range::from(0.0, 1e6));
  body.start.position.y() =
      -table.number_or("distance_mm", 0.1 * mm, Range::from(1e-3, 1e4), mm);  // moved on in motion_of
}

/// Of the push along y: 1 with the wire's bulge, -1 against it.
double side_of(const coupling::PushProblem& push) {
  return push.pusher.direction == coupling::PushDirection::outward ? 1.0 : -1.0;
}

coupling::MotionOptions options_of(const ContactScenario& scenario, const WireModel& model) {
  coupling::MotionOptions options = scenario.options;
  const coupling::MotionBody& body = scenario.body;
  const double speed = body.start.velocity.norm() + body.start.spin.norm() * scenario.probe.norm();
  constexpr double resolved_travel = 1e-4;  // [m]
  if (model.law && speed > 0.0) options.max_step = std::min(options.max_step, resolved_travel / speed);
  return options;
}

}  // namespace

ContactScenario read_contact(TomlDocument& document) {
  const TomlTable root = document.root();
  ContactScenario scenario;
  coupling::MotionOptions& o = scenario.options;
  read_motion_options(root, o);

  const PushTables tables = push_tables(root);
  scenario.push = read_push_problem(tables);
  scenario.push.contact_position = root.number("contact_position_mm", Range::above(0.0, 1e5), mm);
  const double position = scenario.push.contact_position;
  if (std::isfinite(position) && std::isfinite(scenario.push.mount.span)) {  // else reported already
    if (const auto problem = position_problem(position, scenario.push.mount.span))
      root.fail("contact_position_mm", *problem);
  }
  require_simple_motion(tables, scenario.push);

  const TomlTable damping = root.table("damping");
  scenario.damping = read_damping(damping);
  scenario.strand_time = damping.number_or("strand_time_s", scenario.strand_time, Range::from(1e-9, 1.0));
  scenario.strength = read_strength(tables.wire, scenario.push.wire);
  read_body(root.table("body"), scenario);
  scenario.foundation = read_foundation(root.table("foundation"));
  scenario.friction = read_friction(root.table("friction"), scenario.push.pusher.friction, "pusher.friction");

  std::set<std::string> names;
  for (const TomlTable& table : root.tables("models")) {
    scenario.models.push_back(read_model(table));
    if (!names.insert(scenario.models.back().name).second) table.fail("name", "is taken by another model");
  }
  if (scenario.models.empty() && !root.has("models")) scenario.models.push_back({"wire", "wire", {}});

  scenario.elements = root.table("solver").integer_or("elements", 60, 8, 20000);
  scenario.formulation = read_formulation(root.table("solver"));
  scenario.output = read_motion_output(root.table("output"), o);
  scenario.input = document.canonical(least_advance_key);
  document.finish();
  return scenario;
}

ContactScenario read_contact_scenario(const std::filesystem::path& file, const std::vector<base::Override>& overrides) {
  TomlDocument document(file, overrides);
  const TomlTable root = document.root();
  base::require_schema(root, scenario_schema);
  static constexpr Choice<bool> kinds[] = {{"contact", true}};
  static_cast<void>(root.choice("kind", kinds));
  static_cast<void>(root.text("title"));
  static_cast<void>(root.text_or("source", ""));
  return read_contact(document);
}

coupling::Motion motion_of(const ContactScenario& scenario, const WireModel& model) {
  const coupling::PushProblem& push = scenario.push;
  const wire::WireSpecification& w = push.wire;
  wire::RodInMotion rod = wire::rod_in_motion(w, push.mount.span, scenario.elements);
  const auto end = push.mount.kind == wire::MountKind::clamped ? wire::SpatialEnd::Kind::clamp
                                                               : wire::SpatialEnd::Kind::twisting_pin;
  rod.properties.left.kind = rod.properties.right.kind = end;
  rod.formulation = scenario.formulation;
  rod.quasi_static = model.quasi_static;
  rod.damping = scenario.damping;
  rod.strands.time = scenario.strand_time;
  const Eigen::Matrix3Xd rest = coupling::resting_wire(rod);

  // The probe stands below the wire (above it for a push against the bulge) at the asked place.
  const double side = side_of(push);
  Eigen::Index k = 1;
  while (k + 1 < rest.cols() && rest(0, k) < push.contact_position) ++k;
  const double share = (push.contact_position - rest(0, k - 1)) / (rest(0, k) - rest(0, k - 1));
  const Vector3d slope = (rest.col(k) - rest.col(k - 1)).normalized();
  const double height = rest(1, k - 1) + share * (rest(1, k) - rest(1, k - 1));
  const double reach = (push.pusher.radius + 0.5 * w.diameter) / slope.x();  // along y, to a wire that slopes
  const Vector3d touch(push.contact_position, height - side * reach, 0.0);

  coupling::Motion motion;
  motion.gravity = {push.gravity[0], push.gravity[1], push.gravity[2]};
  coupling::MotionBody body = scenario.body;
  body.start.position = touch + side * Vector3d(0.0, scenario.body.start.position.y(), 0.0) - scenario.probe;
  motion.bodies.push_back(body);
  if (model.law) {
    coupling::PointContactLaw spring;
    spring.name = model.name;
    spring.point = scenario.probe;
    spring.origin = touch;
    spring.direction = {0.0, side, 0.0};
    spring.law = model.law;
    motion.springs.push_back(spring);
    return motion;
  }
  motion.wires.push_back({"wire", rod, rest, {}, scenario.strength});
  coupling::MotionContact contact;
  contact.name = model.name;
  contact.shape = std::make_shared<coupling::EndlessCylinder>(push.pusher.radius);
  contact.X_BS.p = scenario.probe;
  contact.wire_radius = 0.5 * w.diameter;
  contact.foundation = scenario.foundation;
  contact.friction = scenario.friction;
  motion.contacts.push_back(contact);
  return motion;
}

WireMotions motions_of(const ContactScenario& scenario) {
  WireMotions motions;
  motions.input = scenario.input;
  motions.duration = scenario.options.duration;
  motions.output = scenario.output;
  motions.probe = {scenario.probe, scenario.push.pusher.radius, side_of(scenario.push),
                   -scenario.body.start.position.y()};
  for (const WireModel& model : scenario.models)
    motions.runs.push_back({model.name, model.kind, motion_of(scenario, model), options_of(scenario, model)});
  return motions;
}

}  // namespace snare::scenario
