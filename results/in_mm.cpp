#include "results/in_mm.hpp"

#include "base/units.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace snare::results {

double in_mm(double metres) {
  const double exact = metres / base::mm;
  std::array<char, 32> text;
  constexpr int digits = 15;  // any decimal number of so many is told apart by a double
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), exact, std::chars_format::general, digits);
  double rounded = exact;
  if (error == std::errc()) std::from_chars(text.data(), end, rounded);
  // As this length but for the round-off of the two products.
  return std::abs(rounded * base::mm - metres) <= std::numeric_limits<double>::epsilon() * std::abs(metres) ? rounded
                                                                                                            : exact;
}

std::vector<double> in_mm(std::vector<double> metres) {
  for (double& v : metres) v = in_mm(v);
  return metres;
}

}  // namespace snare::results
