#pragma once

#include "base/toml_reader.hpp"
#include "coupling/contact/contact_law.hpp"

#include <optional>

namespace snare::scenario {

/// The laws of penetration that files name by `model`, with their numbers beside it: docs/scenario_file.md.
enum class LawModel { spring_dashpot, power, step_damped, quadratic, stretched_wire, stretched_wire_linear };

/// The law, force [N] of penetration [m] and rate [m/s]; empty where a number is wrong, which is reported.
[[nodiscard]] coupling::ContactLaw read_contact_law(const base::TomlTable& table, LawModel model);

/// Of Honda's stretched wire: stiffness of one half, half its length, half the distance of its ends.
struct StretchedHalf {
  double stiffness = 0.0;  ///< [N/m]
  double length = 0.0;     ///< [m]
  double span = 0.0;       ///< [m]
};
/// Nothing where a number is wrong, which is reported.
[[nodiscard]] std::optional<StretchedHalf> read_stretched_half(const base::TomlTable& table);

}  // namespace snare::scenario
