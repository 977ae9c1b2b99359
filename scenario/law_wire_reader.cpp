#include "scenario/law_wire_reader.hpp"

#include "base/units.hpp"
#include "scenario/contact_law_reader.hpp"

#include <cmath>

namespace snare::scenario {

using base::Choice;
using base::mm;
using base::Range;
using base::TomlTable;
using coupling::LawWire;

namespace {

enum class Model { full, quasi_static, stretched, rod, rod_linear };

/// Honda's rod: eq. 1, or 2 where `linear`; nothing where a number is wrong.
std::optional<LawWire> read_rod(const TomlTable& table, bool linear) {
  LawWire wire;
  wire.kind = LawWire::Kind::rod;
  const std::optional<StretchedHalf> half = read_stretched_half(table);
  const double c = table.number_or("damping_Ns_m", 0.0, Range::from(0.0, 1e9));
  if (!half) return std::nullopt;
  wire.standoff = std::sqrt(half->length * half->length - half->span * half->span);
  const coupling::Damping damping = c > 0.0 ? coupling::linear_damping(c) : coupling::Damping{};
  wire.law = linear ? coupling::stretched_wire_tangent(half->stiffness, half->length, half->span, damping)
                    : coupling::stretched_wire_law(half->stiffness, half->length, half->span, damping);
  return wire;
}

}  // namespace

WireStandIn read_wire_stand_in(const TomlTable& table, const wire::WireSpecification& specification,
                               const wire::RodDamping& damping) {
  static constexpr Choice<Model> models[] = {{"full", Model::full},
                                             {"quasi_static", Model::quasi_static},
                                             {"stretched", Model::stretched},
                                             {"rod", Model::rod},
                                             {"rod_linear", Model::rod_linear}};
  WireStandIn result;
  const Model model = table.has("model") ? table.choice("model", models).value_or(Model::full) : Model::full;
  std::optional<LawWire> rod;
  if (table.has("rod")) rod = read_rod(table.table("rod"), model == Model::rod_linear);
  switch (model) {
    case Model::full:
      return result;
    case Model::quasi_static:
      result.quasi_static = true;
      return result;
    case Model::stretched:
      result.law.emplace();
      break;
    case Model::rod:
    case Model::rod_linear:
      if (!table.has("rod"))
        table.fail("rod", "must be a table of the rod's law: half_stiffness_N_m, half_length_mm, half_span_mm");
      result.law = rod.value_or(LawWire{});
      break;
  }
  result.law->radius = 0.5 * specification.diameter;
  result.law->length = specification.length;
  result.law->axial_stiffness = specification.axial_stiffness();
  result.law->axial_time = damping.axial_time;
  return result;
}

}  // namespace snare::scenario
