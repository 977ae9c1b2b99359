#include "identification/fitting/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace snare::identification {

std::string to_string(FindingKind kind) {
  static constexpr const char* names[] = {
      "impossible_stiffness",       "unit_slip",        "sign_turned",     "on_bound",
      "series_of_another_specimen", "series_exchanged", "not_identifiable"};
  return names[static_cast<std::size_t>(kind)];
}

bool has_finding(const std::vector<Finding>& findings, FindingKind kind) {
  return std::ranges::any_of(findings, [kind](const Finding& f) { return f.kind == kind; });
}

AtBound at_bound(double value, double lower, double upper) {
  const double near = std::isfinite(upper - lower) ? 1e-6 * (upper - lower) : 0.0;
  if (std::isfinite(lower) && value <= lower + near) return AtBound::lower;
  if (std::isfinite(upper) && value >= upper - near) return AtBound::upper;
  return AtBound::none;
}

std::string interval_words(std::optional<double> lower, std::optional<double> upper, bool identified,
                           AtBound bound) {
  const auto end = [](std::optional<double> v) {
    return v ? fmt::format("{:.5g}", *v) : std::string("unbounded");
  };
  std::string text;
  if (lower || upper) text = fmt::format("[{}, {}]", end(lower), end(upper));
  if (text.empty() && (!identified || bound == AtBound::none)) text = "not determined by the readings";
  if (bound == AtBound::none) return text;
  return fmt::format("{}{}on its {} bound", text, text.empty() ? "" : ", ",
                     bound == AtBound::lower ? "lower" : "upper");
}

}  // namespace snare::identification
