#pragma once

#include "app/report/report_page.hpp"
#include "identification/tracing/model_error.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// How the pages say numbers and lists. What is not known or not finite is a dash everywhere.
namespace snare::app {

using Words = std::vector<std::string>;

inline constexpr const char* absent = "\u2013";  ///< stands where a value is missing

/// The value where it is there and finite.
[[nodiscard]] std::optional<double> known(std::optional<double> value);

/// At least three digits, trailing zeros kept, and the unit; shown: at most `digits`, none trailing.
[[nodiscard]] std::string measured(std::optional<double> value, const std::string& unit = "");
[[nodiscard]] std::string shown(std::optional<double> value, int digits = 6);
/// 1.6 %; a share far below nothing is not worth its digits.
[[nodiscard]] std::string percent(std::optional<double> share);
[[nodiscard]] Cell yes_no(std::optional<bool> value, Tone yes, Tone no);
[[nodiscard]] std::string joined(const Words& words, const char* last = " and ");
/// mount slip of mount_slip.
[[nodiscard]] std::string spaced(std::string name);
/// {"yield stress", "MPa"} of plasticity.yield_stress_MPa.
[[nodiscard]] std::pair<std::string, std::string> name_and_unit(const std::string& key);
/// A number and its 95 % interval, which may be open at an end, as two cells with the digits that the
/// interval leaves meaningful.
[[nodiscard]] std::vector<Cell> value_cells(std::optional<double> value, std::optional<double> lower,
                                            std::optional<double> upper);
/// The same of a fitted number, with words where it stands on its bound or is not determined.
[[nodiscard]] std::vector<Cell> value_cells(const identification::FittedNumber& number);

}  // namespace snare::app
