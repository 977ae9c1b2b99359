#include "base/unit_names.hpp"

#include "base/blanks.hpp"
#include "base/units.hpp"

#include <algorithm>

namespace snare::base {

namespace {

using Quantity = NamedUnit::Quantity;

// Exact by definition: pound 0.45359237 kg, standard gravity 9.80665 m/s^2, inch 25.4 mm (BIPM, NIST SP 811).
constexpr double kilogram_force = 9.80665;
constexpr double pound_force = 0.45359237 * kilogram_force;

constexpr NamedUnit units[] = {
    {Quantity::length, 1e-3, "mm"},
    {Quantity::length, 1e-2, "cm"},
    {Quantity::length, 1.0, "m"},
    {Quantity::length, 1e-6, "um"},
    {Quantity::length, 1e-6, "\xC2\xB5m"},  // micro sign
    {Quantity::length, 1e-6, "\xCE\xBCm"},  // Greek mu
    {Quantity::length, 0.0254, "in"},
    {Quantity::length, 0.0254, "inch"},
    {Quantity::length, 0.3048, "ft"},
    {Quantity::force, 1.0, "N"},
    {Quantity::force, 1e3, "kN"},
    {Quantity::force, 1e-3, "mN"},
    {Quantity::force, 1e6, "MN"},
    {Quantity::force, 1e-2, "cN"},
    {Quantity::force, kilogram_force, "kgf"},
    {Quantity::force, kilogram_force, "kp"},
    {Quantity::force, 1e-3 * kilogram_force, "gf"},
    {Quantity::force, pound_force, "lbf"},
    {Quantity::force, pound_force, "lb"},
    {Quantity::force, 1e3 * pound_force, "kip"},
    {Quantity::time, 1.0, "s"},
    {Quantity::time, 1.0, "sec"},
    {Quantity::time, 1e-3, "ms"},
    {Quantity::time, 1e-6, "us"},
    {Quantity::time, 60.0, "min"},
    {Quantity::angle, 1.0, "rad"},
    {Quantity::angle, degree, "deg"},
};

/// Where the unit of a name begins, with what sets it off; npos where there is none.
std::size_t unit_begin(std::string_view name) {
  if (name.ends_with(')')) return name.rfind('(');
  if (name.ends_with(']')) return name.rfind('[');
  return name.find_last_of("_/ ");
}

}  // namespace

std::optional<NamedUnit> unit_of(std::string_view text) {
  text = trimmed(text);
  const bool bracketed = text.size() > 2 && ((text.front() == '(' && text.back() == ')') ||
                                             (text.front() == '[' && text.back() == ']'));
  if (bracketed) text = trimmed(text.substr(1, text.size() - 2));
  const auto found = std::ranges::find(units, text, &NamedUnit::name);
  return found == std::end(units) ? std::nullopt : std::optional(*found);
}

std::optional<NamedUnit> unit_in_name(std::string_view name) {
  name = trimmed(name);
  const std::size_t at = unit_begin(name);
  if (at == std::string_view::npos || at == 0) return std::nullopt;
  if (name[at] == '(' || name[at] == '[') return unit_of(name.substr(at));
  const std::string_view last = name.substr(at + 1);
  if (last == "min" || last == "in") return std::nullopt;  // a minimum, a word
  return unit_of(last);
}

std::string_view without_unit(std::string_view name) {
  name = trimmed(name);
  return unit_in_name(name) ? trimmed(name.substr(0, unit_begin(name))) : name;
}

}  // namespace snare::base
