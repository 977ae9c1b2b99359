#pragma once

#include "base/json_fields.hpp"
#include "app/report/report_page.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What the sections of the trace's page share: fields of its JSON, and the words for them.
namespace snare::app::trace_page {

using nlohmann::json;
using Words = std::vector<std::string>;

inline constexpr const char* absent = "\u2013";  ///< stands where a value is missing

// Fields: what is absent or null is empty; a value of the wrong type throws std::invalid_argument that names the key.

void require_finite(const json& value, const std::string& key);
void require(bool right, const std::string& key, const char* expected, const json& value);
[[nodiscard]] const json& object(const json& parent, const std::string& key);
[[nodiscard]] std::optional<bool> flag(const json& parent, const std::string& key);
/// An array of objects; a null among them is an object without any key.
[[nodiscard]] const json& objects(const json& parent, const std::string& key);
[[nodiscard]] std::vector<Words> text_lists(const json& parent, const std::string& key);

// Words.

[[nodiscard]] std::string measured(std::optional<double> value, const std::string& unit = "");
[[nodiscard]] std::string shown(std::optional<double> value, int digits = 6);
/// 1.6 %; a share far below nothing is not worth its digits.
[[nodiscard]] std::string percent(std::optional<double> share);
[[nodiscard]] Cell yes_no(std::optional<bool> value, Tone yes, Tone no);
[[nodiscard]] std::string joined(const Words& words, const char* last = " and ");
[[nodiscard]] std::string spaced(std::string name);
/// {"yield stress", "MPa"} of plasticity.yield_stress_MPa.
[[nodiscard]] std::pair<std::string, std::string> name_and_unit(const std::string& key);
/// A number and its 95 % interval, which may be open at an end, as two cells with the digits that the interval leaves meaningful.
[[nodiscard]] std::vector<Cell> value_cells(std::optional<double> value, std::optional<double> lower,
                                            std::optional<double> upper);
[[nodiscard]] Column number_column(std::string heading);

}  // namespace snare::app::trace_page
