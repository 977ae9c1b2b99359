#pragma once

#include "coupling/contact/ranged_law.hpp"
#include "reduction/distil.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace snare::reduction {

// What the writers of exports share. Texts of users never pass through `filled`.

/// Names and what stands for them.
using Replacements = std::vector<std::pair<std::string_view, std::string>>;

/// The source with "@name@" replaced for every name; the replacements themselves are not searched.
[[nodiscard]] std::string filled(std::string_view source, const Replacements& replacements);

/// Numbers of any unit that read back to the same doubles, separated by commas, `per_line` a line.
[[nodiscard]] std::string number_list(const std::vector<double>& values, std::size_t per_line = 8,
                                      std::string_view line_break = ",\n  ");

/// "s40", "s52_5": a position [m], in mm, in a name that every language accepts.
[[nodiscard]] std::string position_name(double position);

/// Positions that a table answers without continuation [m]: its own, and their mirror image where left and
/// right are alike.
[[nodiscard]] std::vector<Interval> covered_positions(const coupling::ForceTable& table);

/// Lines that say what a file holds, without line breaks and control characters; the title first.
[[nodiscard]] std::vector<std::string> head_lines(const DistilledCase& one, const std::string& title);

/// What evaluating a table needs: span, scale, mirror (whether positions are mirrored: "1" or "0"), nd, ns,
/// ne (numbers of knots), last (the last travel over the span).
[[nodiscard]] Replacements table_numbers(const coupling::ForceTable& table);

/// A simple law of a case as an export writes it.
struct ExportedLaw {
  std::string name;         ///< of the function: "quadratic_s40"
  std::string words;        ///< formula and largest error
  Replacements of_numbers;  ///< end, end_force, end_stiffness and the expression: see RangedLaw
};
/// prefix: of mathematical functions, see LawForm::expression.
[[nodiscard]] std::vector<ExportedLaw> exported_laws(const DistilledPlace& place, const std::string& prefix);

/// Numbers of the load/unload law of a place: turn, position, slack, sum, difference.
[[nodiscard]] Replacements load_unload_numbers(const DistilledCase& one, const DistilledPlace& place);

}  // namespace snare::reduction
