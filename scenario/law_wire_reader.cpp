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

enum class Model { full, quasi_static, stretched, rod, rod_linear, push };

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
                               const wire::RodDamping& damping, const std::optional<BesideScenario>& beside) {
  static constexpr Choice<Model> of_any[] = {{"full", Model::full},
                                             {"quasi_static", Model::quasi_static},
                                             {"stretched", Model::stretched},
                                             {"rod", Model::rod},
                                             {"rod_linear", Model::rod_linear}};
  static constexpr Choice<Model> of_listed[] = {{"full", Model::full},
                                                {"quasi_static", Model::quasi_static},
                                                {"stretched", Model::stretched},
                                                {"rod", Model::rod},
                                                {"rod_linear", Model::rod_linear},
                                                {"table", Model::push},
                                                {"quadratic", Model::push},
                                                {"spring_dashpot", Model::push},
                                                {"power", Model::push},
                                                {"step_damped", Model::push},
                                                {"stretched_wire", Model::push},
                                                {"stretched_wire_linear", Model::push}};
  WireStandIn result;
  Model model = Model::full;
  if (table.has("model"))
    model = (beside ? table.choice("model", of_listed) : table.choice("model", of_any)).value_or(Model::full);
  std::optional<LawWire> rod;
  if (table.has("rod")) rod = read_rod(table.table("rod"), model == Model::rod_linear);
  const std::string name = table.text_or("model", "full");
  for (const PushModelName& push : push_models()) {
    if (!beside) break;
    if (push.model == name)
      result.push = read_push_model(table, push.model, *beside);
    else if (table.has(push.table))
      read_numbers(table, push.model);
  }
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
        table.fail("rod",
                   "must be a table of the rod's law: half_stiffness_N_m, half_length_mm, half_span_mm");
      result.law = rod.value_or(LawWire{});
      break;
    case Model::push:
      result.law.emplace().kind = LawWire::Kind::push;
      break;
  }
  result.law->radius = 0.5 * specification.diameter;
  result.law->length = specification.length;
  result.law->axial_stiffness = specification.axial_stiffness();
  result.law->axial_time = damping.axial_time;
  return result;
}

std::vector<std::string> models_with_numbers(const TomlTable& table) {
  std::vector<std::string> models;
  for (const PushModelName& push : push_models()) {
    if (table.has(push.table)) models.emplace_back(push.model);
  }
  return models;
}

}  // namespace snare::scenario
