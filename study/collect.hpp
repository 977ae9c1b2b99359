#pragma once

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snare::study {

/// A field of a case's result: where it stands, and what is made of several.
///
/// "outcome.caught", "outcome.peak_tension_N[snare::wire_1]", "series[s40].largest_force_N",
/// "bodies[1].position_after_mm[3]"; "max outcome.peak_tension_N[*]". In brackets: a key, an element's name,
/// or its number from 1; `*`: all.
struct Collected {
  enum class Taken { value, least, most, sum, mean, count };
  struct Step {
    std::string key;
    bool bracket = false;
  };

  std::string name;  ///< of its column
  std::string text;  ///< as it was written
  Taken taken = Taken::value;
  std::vector<Step> path;
};

/// Reads a field's place; nothing where it is not of the form above.
[[nodiscard]] std::optional<Collected> parse_collected(std::string name, std::string_view text);

/// The field of a result: a number, a boolean, a text, or null where the result has null there. Of several by
/// `max` and so on the nulls do not count; of none but nulls comes null (of `count`, 0; a boolean counts
/// where it is true).
/// Throws std::out_of_range, with what there is, when the result has no such field.
[[nodiscard]] nlohmann::json collected(const Collected& field, const nlohmann::json& result);

}  // namespace snare::study
