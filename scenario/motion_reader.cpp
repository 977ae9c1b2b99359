#include "scenario/motion_reader.hpp"

#include "base/decimal.hpp"
#include "base/units.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>

namespace snare::scenario {

using base::Choice;
using base::degree;
using base::Range;
using base::TomlTable;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

std::optional<Vector3d> read_vector(const TomlTable& table, std::string_view key, Range range, double unit) {
  const std::vector<double> v = table.numbers(key, 3, 3, range, unit);
  if (v.size() != 3) return std::nullopt;
  return Vector3d(v[0], v[1], v[2]);
}

Vector3d read_vector_or_zero(const TomlTable& table, std::string_view key, Range range, double unit) {
  if (!table.has(key)) return Vector3d::Zero();
  return read_vector(table, key, range, unit).value_or(Vector3d::Zero());
}

Matrix3d read_rotation_vector(const TomlTable& table, std::string_view key) {
  const Vector3d turn = read_vector_or_zero(table, key, Range::from(-360.0, 360.0), degree);
  const double angle = turn.norm();
  return angle > 0.0 ? AngleAxisd(angle, turn / angle).toRotationMatrix() : Matrix3d::Identity();
}

Matrix3d read_roll_pitch_yaw(const TomlTable& table, std::string_view key) {
  const Vector3d turn = read_vector_or_zero(table, key, Range::from(-360.0, 360.0), degree);
  return (AngleAxisd(turn.z(), Vector3d::UnitZ()) * AngleAxisd(turn.y(), Vector3d::UnitY()) *
          AngleAxisd(turn.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

multibody::RigidBodyProperties read_body_properties(const TomlTable& table) {
  multibody::RigidBodyProperties properties;
  properties.mass = table.number("mass_kg", Range::above(0.0, 1e7));
  if (const auto inertia = read_vector(table, "inertia_kg_m2", Range::above(0.0, 1e12), 1.0)) {
    properties.inertia = inertia->asDiagonal();
    const double largest = inertia->maxCoeff();
    if (base::exceeds(largest, inertia->sum() - largest))
      table.fail("inertia_kg_m2",
                 "must satisfy the triangle inequality: none larger than the other two together");
  }
  return properties;
}

void read_motion_options(const TomlTable& root, coupling::MotionOptions& o) {
  o.duration = root.number("duration_s", durations);
  o.output_interval = root.number_or("output_interval_s", 1e-3, durations);
  if (base::exceeds(o.duration / o.output_interval, most_outputs))
    root.fail("output_interval_s", fmt::format("gives more than {:g} lines", most_outputs));
  const TomlTable solver = root.table("solver");
  const auto tolerance = [&solver](std::string_view key, double& value, double most) {
    value = solver.number_or(key, value, Range::above(0.0, most));
  };
  o.relative_tolerance =
      solver.number_or("relative_tolerance", o.relative_tolerance, Range::from(1e-10, 1e-2));
  tolerance("position_tolerance_m", o.position_tolerance, 1e-3);
  tolerance("velocity_tolerance_m_s", o.velocity_tolerance, 1.0);
  tolerance("quasi_static_velocity_tolerance_m_s", o.quasi_static_velocity_tolerance, 1.0);
  tolerance("body_position_tolerance_m", o.body_position_tolerance, 1e-3);
  tolerance("body_velocity_tolerance_m_s", o.body_velocity_tolerance, 1.0);
  tolerance("body_angle_tolerance_rad", o.angle_tolerance, 1e-3);
  tolerance("body_spin_tolerance_rad_s", o.spin_tolerance, 1.0);
  if (solver.has("max_order")) o.max_order = solver.integer("max_order", 1, 5);
  if (solver.has("newton_share")) o.newton_share = solver.number("newton_share", Range::from(1e-6, 0.5));
  o.peak_window = solver.number_or("peak_window_s", o.peak_window, Range::from(0.0, 1.0));
  o.least_advance = solver.number_or("least_advance_s", least_advance, Range::from(0.0, 1e6));
  o.max_step = solver.number_or("max_step_s", 1e9, Range::above(0.0, 1e9));
}

MotionOutput read_motion_output(const TomlTable& table, coupling::MotionOptions& o) {
  MotionOutput output;
  o.wire_loads = output.paraview = table.boolean_or("paraview", output.paraview);
  o.checkpoint_interval = table.number_or("checkpoint_interval_s", o.duration / 10.0, durations);
  if (base::exceeds(o.duration / o.checkpoint_interval, most_outputs))
    table.fail("checkpoint_interval_s", fmt::format("gives more than {:g} checkpoints", most_outputs));
  output.checkpoint_wall_time =
      table.number_or("checkpoint_wall_time_s", output.checkpoint_wall_time, Range::from(0.0, 1e6));
  return output;
}

namespace {

/// Of stretch [s]. A wire that takes longer to give way along itself is rigid for what a motion lasts; metals
/// take 1e-7 to 1e-4 s.
constexpr double longest_axial_time = 0.1;

}  // namespace

wire::RodDamping read_damping(const TomlTable& table) {
  wire::RodDamping damping;
  damping.bending_time = table.number_or("bending_time_s", 1e-5, Range::from(0.0, 10.0));
  damping.axial_time = table.number_or("axial_time_s", 1e-5, Range::from(0.0, longest_axial_time));
  damping.mass_rate = table.number_or("mass_rate_1_s", 0.0, Range::from(0.0, 1e6));
  return damping;
}

coupling::ElasticFoundation read_foundation(const TomlTable& table) {
  coupling::ElasticFoundation f;
  f.modulus = table.number_or("modulus_N_m2", f.modulus, Range::from(0.0, 1e16));
  f.damping = table.number_or("damping_s_m", f.damping, Range::from(0.0, 1e6));
  return f;
}

coupling::WireStrength read_strength(const TomlTable& table, const wire::WireSpecification& wire) {
  static constexpr Choice<bool> ways[] = {{"flag", false}, {"stop", true}};
  const bool ends_run = table.has("at_strength") && table.choice("at_strength", ways).value_or(false);
  if (!table.has("strength_N")) {
    if (table.has("at_strength")) table.fail("at_strength", "only beside strength_N");
    return {};
  }
  constexpr double least = 1e-9;  // [N]: what takes a share of less takes more shares than can be counted
  const double strength = table.number("strength_N", Range::above(0.0, 1e9));
  if (strength < least) table.fail("strength_N", fmt::format("must be >= {}", least));
  return coupling::wire_strength(wire, strength, ends_run);
}

wire::Formulation read_formulation(const TomlTable& table) {
  static constexpr Choice<wire::Formulation> formulations[] = {
      {"vertices", wire::Formulation::vertices}, {"higher_order", wire::Formulation::higher_order}};
  if (!table.has("formulation")) return wire::Formulation::higher_order;
  return table.choice("formulation", formulations).value_or(wire::Formulation::higher_order);
}

coupling::MotionFriction read_friction(const TomlTable& table, double dynamic, std::string_view dynamic_key) {
  static constexpr Choice<coupling::ContactFriction> laws[] = {
      {"stick_slip", coupling::ContactFriction::stick_slip}, {"smooth", coupling::ContactFriction::smooth}};
  coupling::MotionFriction f;
  if (table.has("law")) f.law = table.choice("law", laws).value_or(f.law);
  f.dynamic_coefficient = dynamic;
  f.static_coefficient = table.number_or("static_friction", dynamic, Range::from(0.0, 5.0));
  f.static_speed = table.number_or("static_speed_m_s", 0.01, Range::from(0.0, 10.0));
  f.dynamic_speed = table.number_or("dynamic_speed_m_s", 1.0, Range::from(0.0, 100.0));
  f.bristle_displacement =
      table.number_or("bristle_displacement_m", f.bristle_displacement, Range::from(1e-10, 1e-2));
  f.bristle_time = table.number_or("bristle_time_s", f.bristle_time, Range::from(1e-9, 1.0));
  const bool at_once =
      f.law == coupling::ContactFriction::stick_slip && f.static_speed == 0.0 && f.dynamic_speed == 0.0;
  if (f.dynamic_speed <= f.static_speed && !at_once)
    table.fail("dynamic_speed_m_s", "must be > static_speed_m_s (with stick_slip both may be 0)");
  if (f.law == coupling::ContactFriction::smooth) {
    if (f.static_speed == 0.0) table.fail("static_speed_m_s", "must be > 0 with the smooth law");
    for (const char* key : {"bristle_displacement_m", "bristle_time_s"}) {
      if (table.has(key)) table.fail(key, "belongs to law = \"stick_slip\"");
    }
  } else if (f.static_coefficient < dynamic) {
    table.fail("static_friction", fmt::format("must be at least {} with law = \"stick_slip\"", dynamic_key));
  }
  return f;
}

}  // namespace snare::scenario
