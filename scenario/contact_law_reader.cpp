#include "scenario/contact_law_reader.hpp"

#include "base/units.hpp"

namespace snare::scenario {

using base::mm;
using base::Range;
using base::TomlTable;
using coupling::ContactLaw;

std::optional<StretchedHalf> read_stretched_half(const TomlTable& table) {
  StretchedHalf half;
  half.stiffness = table.number("half_stiffness_N_m", Range::above(0.0, 1e15));
  half.length = table.number("half_length_mm", Range::above(0.0, 1e5), mm);
  half.span = table.number("half_span_mm", Range::above(0.0, 1e5), mm);
  if (half.length < half.span) {
    table.fail("half_length_mm", "must be >= half_span_mm");
    return std::nullopt;
  }
  return half;
}

ContactLaw read_contact_law(const TomlTable& table, LawModel model) {
  const Range stiffness = Range::above(0.0, 1e15);
  const Range damping = Range::from(0.0, 1e15);
  switch (model) {
    case LawModel::spring_dashpot:
      return coupling::spring_dashpot(table.number("k_N_m", stiffness),
                                      table.number_or("c_Ns_m", 0.0, damping));
    case LawModel::power: {
      const double p = table.number("p", Range::from(1.0, 10.0));
      const double n = table.number_or("n", p, Range::from(0.0, 10.0));
      if (n > 0.0 && n < 1.0)
        table.fail("n", "must be 0 or >= 1: between, the force would rise infinitely fast");
      return coupling::power_law(table.number("k", stiffness), p, table.number_or("c", 0.0, damping),
                                 table.number_or("q", 1.0, Range::from(1.0, 10.0)), n);
    }
    case LawModel::step_damped:
      return coupling::step_damped_law(
          table.number("k", stiffness), table.number("p", Range::from(1.0, 10.0)),
          table.number("c_Ns_m", damping), table.number("full_depth_mm", Range::above(0.0, 1e3), mm));
    case LawModel::quadratic: {
      const Range coefficient = Range::from(-1e12, 1e12);
      return coupling::quadratic_law(table.number("A_N_m2", coefficient), table.number("B_N_m", coefficient),
                                     table.number("C_N", coefficient));
    }
    case LawModel::stretched_wire:
    case LawModel::stretched_wire_linear: {
      const std::optional<StretchedHalf> half = read_stretched_half(table);
      if (!half) return {};
      return model == LawModel::stretched_wire
                 ? coupling::stretched_wire_law(half->stiffness, half->length, half->span)
                 : coupling::stretched_wire_tangent(half->stiffness, half->length, half->span);
    }
  }
  return {};
}

}  // namespace snare::scenario
