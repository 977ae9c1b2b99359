#pragma once

#include <optional>
#include <string_view>

namespace snare::base {

/// A unit as machines and people write it.
struct NamedUnit {
  enum class Quantity { length, force, time, angle };
  Quantity quantity{};
  double si = 1.0;             ///< SI units in one of these, 1e-3 for mm
  std::string_view name = {};  ///< as it was written, without brackets
};

/// The unit that a text is: "mm", "(kN)", "[s]"; nothing where it is unknown. The case of letters
/// counts (mN, MN).
[[nodiscard]] std::optional<NamedUnit> unit_of(std::string_view text);

/// The unit at the end of a column's name: "force_N", "Load (kN)", "Weg [mm]", "Extension/mm".
[[nodiscard]] std::optional<NamedUnit> unit_in_name(std::string_view name);

/// The name before its unit.
[[nodiscard]] std::string_view without_unit(std::string_view name);

}  // namespace snare::base
