#include "base/in_unit.hpp"

#include "base/range.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace snare::base {

namespace {

/// The decimal number that `shown` may stand for, `si` being what it was made from.
double decimal_of(double shown, double si, double unit) {
  std::array<char, 32> text;
  constexpr int digits = 15;  // any decimal number of so many is told apart by a double
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), shown, std::chars_format::general, digits);
  double rounded = shown;
  if (error == std::errc()) std::from_chars(text.data(), end, rounded);
  // As this number but for the round-off of reading and of what was done with it since.
  return std::abs(to_si(rounded, unit) - si) <= std::numeric_limits<double>::epsilon() * std::abs(si)
             ? rounded
             : shown;
}

}  // namespace

double in_unit(double si, double unit) {
  // Times 1000 for mm: 1e-3 is no double.
  const double per_si = 1.0 / unit;
  return decimal_of(per_si == std::round(per_si) ? si * per_si : si / unit, si, unit);
}

double without_tail(double shown, double unit) {
  return decimal_of(shown, to_si(shown, unit), unit);
}

}  // namespace snare::base
