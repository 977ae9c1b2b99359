#include "base/range.hpp"

#include <fmt/format.h>

#include <cmath>

namespace snare::base {

bool Range::contains(double value) const noexcept {
  if (!std::isfinite(value)) return false;
  return (includes_low ? value >= low : value > low) && value <= high;
}

std::string Range::phrase() const {
  std::string text;
  if (std::isfinite(low)) text = fmt::format("{} {:.7g}", includes_low ? ">=" : ">", low);
  if (std::isfinite(high)) text += fmt::format("{}<= {:.7g}", text.empty() ? "" : " and ", high);
  return text;
}

}  // namespace snare::base
