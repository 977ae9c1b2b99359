#include "scenario/push_writer.hpp"

#include "base/in_unit.hpp"
#include "base/units.hpp"
#include "scenario/push_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace snare::scenario {

namespace {

using base::degree;
using base::GPa;
using base::in_unit;
using base::mm;

constexpr double MPa = 1e6;  // [Pa]

/// The stiffness of one mount beside that of each, none where it gives no more.
std::optional<double> own_stiffness(double compliance) {
  return compliance != 0.0 ? std::optional(1.0 / compliance) : std::nullopt;
}

/// A number as TOML has it: every digit, and a point or an exponent, so that it is no integer.
std::string decimal(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// The lines of one table.
class Table {
 public:
  explicit Table(std::string_view name) : text_(fmt::format("[{}]\n", name)) {}

  Table& word(std::string_view key, std::string_view value) {
    text_ += fmt::format("{} = \"{}\"\n", key, value);
    return *this;
  }
  Table& number(std::string_view key, double si, double unit = 1.0) {
    text_ += fmt::format("{} = {}\n", key, decimal(in_unit(si, unit)));
    return *this;
  }
  Table& number(std::string_view key, const std::optional<double>& si, double unit = 1.0) {
    return si ? number(key, *si, unit) : *this;
  }
  Table& unless_zero(std::string_view key, double si, double unit = 1.0) {
    return si != 0.0 ? number(key, si, unit) : *this;
  }
  Table& line(const std::string& text) {
    text_ += text + '\n';
    return *this;
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

std::string wire_table(const wire::WireSpecification& wire) {
  Table table("wire");
  table.word("construction", wire.construction == wire::Construction::strand ? "strand" : "solid")
      .number("diameter_mm", wire.diameter, mm)
      .number("length_mm", wire.length, mm)
      .number("youngs_modulus_GPa", wire.youngs_modulus, GPa)
      .number("poisson_ratio", wire.poisson_ratio)
      .number("density_kg_m3", wire.density)
      .number("bending_stiffness_Nm2", wire.bending_stiffness())
      .number("axial_stiffness_N", wire.axial_stiffness())
      .number("torsional_stiffness_Nm2", wire.torsional_stiffness_override)
      .unless_zero("natural_curvature_1_m", wire.natural_curvature);
  if (wire.strand_friction) {
    table.number("strand_extra_stiffness_Nm2", wire.strand_friction->extra_stiffness)
        .number("strand_slip_curvature_1_m", wire.strand_friction->slip_curvature)
        .unless_zero("strand_slip_breadth", wire.strand_friction->breadth);
  }
  if (wire.yielding) {
    table.number("yield_stress_MPa", wire.yielding->yield_stress, MPa)
        .number("hardening_ratio", wire.yielding->hardening_ratio);
  }
  return table.text();
}

std::string mount_table(const wire::MountSpecification& mount) {
  Table table("mount");
  switch (mount.kind) {
    case wire::MountKind::clamped:
      table.word("kind", "clamped");
      break;
    case wire::MountKind::pinned:
      table.word("kind", "pinned");
      break;
    case wire::MountKind::supports:
      table.word("kind", "supports");
      break;
  }
  table.number("span_mm", mount.span, mm);
  if (mount.kind == wire::MountKind::supports) {
    table.number("support_radius_mm", mount.support_radius, mm);
    return table.text();
  }
  const bool clamped = mount.kind == wire::MountKind::clamped;
  table.number("translational_stiffness_N_m", mount.translational_stiffness);
  if (clamped) table.number("rotational_stiffness_Nm_rad", mount.rotational_stiffness);
  for (const std::size_t k : {0, 1}) {
    table.number(own_translational_keys[k], own_stiffness(mount.own_translational_compliance[k]));
    if (clamped) table.number(own_rotational_keys[k], own_stiffness(mount.own_rotational_compliance[k]));
  }
  if (mount.slip_tension) {
    constexpr const char* places[] = {"left", "right", "both"};
    table.number("slip_tension_N", *mount.slip_tension)
        .word("slip", mount.slip == wire::MountSlip::slides ? "slides" : "feeds")
        .word("slip_at", places[static_cast<int>(mount.slip_at)]);
  }
  return table.text();
}

std::string pusher_table(const coupling::PusherSpecification& pusher) {
  return Table("pusher")
      .word("shape", "cylinder")
      .number("radius_mm", pusher.radius, mm)
      .number("friction", pusher.friction)
      .word("direction", pusher.direction == coupling::PushDirection::inward ? "inward" : "outward")
      .unless_zero("compliance_m_N", pusher.compliance)
      .unless_zero("tilt_deg", pusher.tilt, degree)
      .unless_zero("misalignment_deg", pusher.misalignment, degree)
      .text();
}

}  // namespace

std::string push_tables_text(const coupling::PushProblem& push) {
  std::string text =
      wire_table(push.wire) + '\n' + mount_table(push.mount) + '\n' + pusher_table(push.pusher);
  const coupling::BulgeSpecification usual;
  if (push.bulge.mode != usual.mode || push.bulge.plane != usual.plane) {
    text += '\n' + Table("bulge")
                       .line(fmt::format("mode = {}", push.bulge.mode))
                       .unless_zero("plane_deg", push.bulge.plane, degree)
                       .text();
  }
  const auto& g = push.gravity;
  if (g[0] != 0.0 || g[1] != 0.0 || g[2] != 0.0) {
    text += '\n' +
            Table("gravity")
                .line(fmt::format("vector_m_s2 = [{}, {}, {}]", decimal(g[0]), decimal(g[1]), decimal(g[2])))
                .text();
  }
  return text;
}

}  // namespace snare::scenario
