#include "scenario/push_reader.hpp"

#include "base/decimal.hpp"
#include "base/units.hpp"

#include <fmt/format.h>

#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snare::scenario {

namespace {

using base::Choice;
using base::Range;
using base::TomlTable;

using base::degree;
using base::GPa;
using base::mm;

// Upper bounds keep slips of the unit out (a length in um, a modulus in Pa) and every product finite.
constexpr double largest_length = 1e5;                // [mm]
constexpr double largest_force = 1e9;                 // [N]
constexpr double largest_breadth = 5.0;               // curvatures that differ by e^10
constexpr double largest_stiffness = 1e15;            // [N/m], [N m/rad], [N]
constexpr double smallest_bending_stiffness = 1e-15;  // [N m^2]; a glass fibre of 10 um has 3e-11
constexpr double smallest_axial_stiffness = 1e-12;    // [N]
constexpr double smallest_mass = 1e-15;               // [kg/m]; the same fibre has 2e-7
constexpr double shortest_length = 0.99;              // of the span, between clamps or pins
constexpr double mount_margin = 0.01;                 // of the span, between contact and mount
constexpr double thickest_wire = 0.2;                 // of the span

/// Length for a message, in mm without rounding noise.
std::string in_mm(double metres) {
  return fmt::format("{:.6g}", metres / mm);
}

}  // namespace

namespace {

/// The modulus, or where it is left out the one with which a solid round section has the declared stiffness,
/// by which strains become stresses. It may be left out where every stiffness that is needed is declared.
void read_modulus(const TomlTable& table, Held held, wire::WireSpecification& wire) {
  const bool known =
      wire.bending_stiffness_override && (wire.axial_stiffness_override || held == Held::on_supports);
  const auto ratio = Range::above(-1.0, 0.5);
  if (table.has("poisson_ratio") || !known) wire.poisson_ratio = table.number("poisson_ratio", ratio);
  if (table.has("youngs_modulus_GPa") || !known) {
    wire.youngs_modulus = table.number("youngs_modulus_GPa", Range::above(0.0, 1e4), GPa);
    return;
  }
  const double area = 0.25 * std::numbers::pi * wire.diameter * wire.diameter;
  wire.youngs_modulus = wire.axial_stiffness_override ? *wire.axial_stiffness_override / area
                                                      : *wire.bending_stiffness_override /
                                                            (area * wire.diameter * wire.diameter / 16.0);
}

}  // namespace

wire::WireSpecification read_wire(const TomlTable& table, Held held, std::optional<double> natural_length) {
  static constexpr Choice<wire::Construction> constructions[] = {{"solid", wire::Construction::solid},
                                                                 {"strand", wire::Construction::strand}};
  wire::WireSpecification wire;
  wire.construction = table.choice("construction", constructions).value_or(wire.construction);
  wire.diameter = table.number("diameter_mm", Range::above(0.0, 100.0), mm);
  const Range length = Range::above(0.0, largest_length);
  wire.length = natural_length ? table.number_or("length_mm", *natural_length, length, mm)
                               : table.number("length_mm", length, mm);
  wire.density = table.number("density_kg_m3", Range::above(0.0, 1e5));
  const Range bending = Range::from(smallest_bending_stiffness, 1e9);
  wire.bending_stiffness_override = table.optional_number("bending_stiffness_Nm2", bending);
  wire.axial_stiffness_override =
      table.optional_number("axial_stiffness_N", Range::above(0.0, largest_stiffness));
  wire.torsional_stiffness_override = table.optional_number("torsional_stiffness_Nm2", bending);
  read_modulus(table, held, wire);
  wire.natural_curvature = table.number_or("natural_curvature_1_m", 0.0, Range::from(-1e4, 1e4));
  if (const auto stress = table.optional_number("yield_stress_MPa", Range::from(1.0, 1e9))) {
    wire::Yielding yielding;
    yielding.yield_stress = 1e6 * *stress;
    yielding.hardening_ratio =
        table.number_or("hardening_ratio", wire::Yielding::usual_hardening, Range::from(0.002, 0.9));
    wire.yielding = yielding;
  } else if (table.has("hardening_ratio")) {
    table.fail("hardening_ratio", "only beside yield_stress_MPa");
  }
  const auto extra = table.optional_number("strand_extra_stiffness_Nm2", bending);
  const auto slip = table.optional_number("strand_slip_curvature_1_m", Range::from(1e-4, 1e4));
  const auto breadth = table.optional_number("strand_slip_breadth", Range::from(0.0, largest_breadth));
  if (extra && slip)
    wire.strand_friction = wire::StrandFriction{*extra, *slip, breadth.value_or(0.0)};
  else if (breadth)
    table.fail("strand_slip_breadth", "only beside strand_extra_stiffness_Nm2 and strand_slip_curvature_1_m");
  else if (extra)
    table.fail("strand_extra_stiffness_Nm2", "needs strand_slip_curvature_1_m beside it");
  else if (slip)
    table.fail("strand_slip_curvature_1_m", "needs strand_extra_stiffness_Nm2 beside it");
  if (wire.bending_stiffness() < smallest_bending_stiffness)
    table.fail("diameter_mm", fmt::format("gives a bending stiffness of {:.3g} N m^2, must be >= {}",
                                          wire.bending_stiffness(), smallest_bending_stiffness));
  else if (wire.axial_stiffness() < smallest_axial_stiffness)
    table.fail("diameter_mm", fmt::format("gives an axial stiffness of {:.3g} N, must be >= {}",
                                          wire.axial_stiffness(), smallest_axial_stiffness));
  else if (wire.mass_per_length() < smallest_mass)
    table.fail("density_kg_m3", fmt::format("gives a mass of {:.3g} kg/m, must be >= {}",
                                            wire.mass_per_length(), smallest_mass));
  return wire;
}

std::array<const char*, 7> keys_of_giving_mounts() {
  return {"slip_tension_N",         "rotational_stiffness_Nm_rad", "translational_stiffness_N_m",
          own_rotational_keys[0],   own_rotational_keys[1],        own_translational_keys[0],
          own_translational_keys[1]};
}

namespace {

wire::MountSpecification read_mount(const TomlTable& table) {
  static constexpr Choice<wire::MountKind> kinds[] = {{"clamped", wire::MountKind::clamped},
                                                      {"pinned", wire::MountKind::pinned},
                                                      {"supports", wire::MountKind::supports}};
  const Range stiffness = Range::above(0.0, largest_stiffness);
  wire::MountSpecification mount;
  const std::optional<wire::MountKind> kind = table.choice("kind", kinds);
  mount.kind = kind.value_or(mount.kind);
  mount.span = table.number("span_mm", Range::above(0.0, largest_length), mm);
  const Range radius = Range::from(0.0, 1000.0);
  if (kind == wire::MountKind::supports)
    mount.support_radius = table.number("support_radius_mm", radius, mm);
  else
    mount.support_radius = table.number_or("support_radius_mm", 0.0, radius, mm);
  mount.translational_stiffness = table.optional_number("translational_stiffness_N_m", stiffness);
  mount.rotational_stiffness = table.optional_number("rotational_stiffness_Nm_rad", stiffness);
  for (const std::size_t k : {0, 1}) {
    if (const auto own = table.optional_number(own_translational_keys[k], stiffness))
      mount.own_translational_compliance[k] = 1.0 / *own;
    if (const auto own = table.optional_number(own_rotational_keys[k], stiffness))
      mount.own_rotational_compliance[k] = 1.0 / *own;
  }
  mount.slip_tension = table.optional_number("slip_tension_N", Range::above(0.0, largest_force));
  static constexpr Choice<wire::MountSlip> slips[] = {{"feeds", wire::MountSlip::feeds},
                                                      {"slides", wire::MountSlip::slides}};
  static constexpr Choice<wire::SlipPlace> places[] = {
      {"left", wire::SlipPlace::left}, {"right", wire::SlipPlace::right}, {"both", wire::SlipPlace::both}};
  for (const char* key : {"slip", "slip_at"}) {
    if (table.has(key) && !mount.slip_tension) table.fail(key, "only beside slip_tension_N");
  }
  if (table.has("slip")) mount.slip = table.choice("slip", slips).value_or(mount.slip);
  if (table.has("slip_at")) mount.slip_at = table.choice("slip_at", places).value_or(mount.slip_at);

  const auto refuse = [&](std::string_view key, std::string_view kinds_that_have_it) {
    if (table.has(key)) table.fail(key, fmt::format("only for a mount of kind {}", kinds_that_have_it));
  };
  if (!kind) return mount;
  if (*kind != wire::MountKind::supports) refuse("support_radius_mm", "\"supports\"");
  if (*kind != wire::MountKind::clamped) {
    for (const char* key : {"rotational_stiffness_Nm_rad", own_rotational_keys[0], own_rotational_keys[1]})
      refuse(key, "\"clamped\"");
  }
  if (*kind == wire::MountKind::supports) {
    for (const char* key :
         {"translational_stiffness_N_m", own_translational_keys[0], own_translational_keys[1]})
      refuse(key, "\"clamped\" or \"pinned\"");
    refuse("slip_tension_N", "\"clamped\" or \"pinned\"");
  }
  return mount;
}

coupling::PusherSpecification read_pusher(const TomlTable& table) {
  static constexpr Choice<bool> shapes[] = {{"cylinder", true}};  // the only one; a knife edge has radius 0
  static constexpr Choice<coupling::PushDirection> directions[] = {
      {"outward", coupling::PushDirection::outward}, {"inward", coupling::PushDirection::inward}};
  coupling::PusherSpecification pusher;
  static_cast<void>(table.choice("shape", shapes));
  pusher.radius = table.number("radius_mm", Range::from(0.0, 100.0), mm);
  pusher.friction = table.number("friction", Range::from(0.0, 2.0));
  pusher.direction = table.choice("direction", directions).value_or(pusher.direction);
  pusher.compliance = table.number_or("compliance_m_N", 0.0, Range::from(0.0, 1e-3));
  pusher.tilt = table.number_or("tilt_deg", 0.0, Range::from(-45.0, 45.0), degree);
  pusher.misalignment = table.number_or("misalignment_deg", 0.0, Range::from(-45.0, 45.0), degree);
  return pusher;
}

coupling::BulgeSpecification read_bulge(const TomlTable& table) {
  coupling::BulgeSpecification bulge;
  bulge.mode = table.integer_or("mode", bulge.mode, 1, 4);
  bulge.plane = table.number_or("plane_deg", 0.0, Range::from(-90.0, 90.0), degree);
  return bulge;
}

std::array<double, 3> read_gravity(const TomlTable& table) {
  if (!table.has("vector_m_s2")) return {0.0, 0.0, 0.0};
  const std::vector<double> values = table.numbers("vector_m_s2", 3, 3, Range::from(-1000.0, 1000.0));
  if (values.size() != 3) return {0.0, 0.0, 0.0};
  return {values[0], values[1], values[2]};
}

// What no key can say alone. A number that was refused is NaN, and no comparison with it holds.
void check_length_and_diameter(const wire::WireSpecification& wire, double span, bool rests,
                               const TomlTable& table) {
  const double shortest = (rests ? 1.0 : shortest_length) * span;
  if (base::exceeds(shortest, wire.length))
    table.fail("length_mm", rests ? fmt::format("must be >= {}, the span of the supports", in_mm(span))
                                  : fmt::format("must be >= {}, {:g} % of the span of {} mm", in_mm(shortest),
                                                100.0 * shortest_length, in_mm(span)));
  if (wire.diameter >= thickest_wire * span)
    table.fail("diameter_mm", fmt::format("must be < {}, a fifth of the span of {} mm",
                                          in_mm(thickest_wire * span), in_mm(span)));
}

}  // namespace

void check_wire_between_mounts(const wire::WireSpecification& wire, double span, const TomlTable& table) {
  check_length_and_diameter(wire, span, false, table);
}

coupling::PushProblem read_wire_and_mounts(const PushTables& tables) {
  coupling::PushProblem test;
  test.mount = read_mount(tables.mount);
  test.wire = read_wire(tables.wire,
                        test.mount.kind == wire::MountKind::supports ? Held::on_supports : Held::at_its_ends);
  check_length_and_diameter(test.wire, test.mount.span, test.mount.kind == wire::MountKind::supports,
                            tables.wire);
  return test;
}

coupling::PushProblem read_push_problem(const PushTables& tables) {
  coupling::PushProblem test = read_wire_and_mounts(tables);
  test.pusher = read_pusher(tables.pusher);
  test.bulge = read_bulge(tables.bulge);
  test.gravity = read_gravity(tables.gravity);
  return test;
}

PushTables push_tables(const TomlTable& root) {
  return {root.table("wire"), root.table("mount"), root.table("pusher"), root.table("bulge"),
          root.table("gravity")};
}

void require_simple_motion(const PushTables& tables, const coupling::PushProblem& test) {
  if (test.mount.kind == wire::MountKind::supports)
    tables.mount.fail("kind",
                      "must be \"clamped\" or \"pinned\": a wire on supports is not computed in motion");
  if (tables.mount.has("slip_tension_N"))
    tables.mount.fail("slip_tension_N", "the wire does not slip in its mounts in motion");
  for (const char* key : {"yield_stress_MPa", "natural_curvature_1_m"}) {
    if (tables.wire.has(key))
      tables.wire.fail(key, "the wire does not yield and is naturally straight in motion");
  }
  if (tables.wire.has("strand_slip_breadth"))
    tables.wire.fail("strand_slip_breadth", "all strands slide at one curvature in motion");
}

std::optional<std::string> position_problem(double position, double span) {
  const double margin = mount_margin * span;
  if (!base::exceeds(margin, position) && !base::exceeds(position, span - margin, {span}))
    return std::nullopt;
  return fmt::format("must be >= {} and <= {}: inside the span of {} mm, {:g} % of it from each mount",
                     in_mm(margin), in_mm(span - margin), in_mm(span), 100.0 * mount_margin);
}

}  // namespace snare::scenario
