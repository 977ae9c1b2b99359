#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// What a finding is about: `findings[].kind` of fit.json and trace.json.
enum class FindingKind {
  impossible_stiffness,        ///< a fitted stiffness that no wire of the declared section and modulus has
  unit_slip,                   ///< readings or fitted numbers differ by the factor between two units
  sign_turned,                 ///< readings have the other sign
  on_bound,                    ///< a fitted number stands on its bound
  series_of_another_specimen,  ///< one series is of another wire than the others
  series_exchanged,            ///< two series are each at the place of the other
  not_identifiable             ///< the readings do not determine a fitted number
};
[[nodiscard]] std::string to_string(FindingKind kind);

/// Something about the readings or the fitted numbers that a user must look at.
struct Finding {
  FindingKind kind = FindingKind::impossible_stiffness;
  std::string key;     ///< of a fitted number, "series[NAME]", or a sensor's column
  std::string unit{};  ///< of `value` and `limit`; empty: pure numbers
  double value = std::numeric_limits<double>::quiet_NaN();  ///< what was found; NaN: no number
  double limit = std::numeric_limits<double>::quiet_NaN();  ///< what it is compared with; NaN: no number
  bool sure = false;                                        ///< no admissible value within the interval
  std::string what{};                                       ///< in words, a sentence without its full stop
};

/// Whether one of the findings is of this kind.
[[nodiscard]] bool has_finding(const std::vector<Finding>& findings, FindingKind kind);

/// At which end of its admissible values a fitted number stands.
enum class AtBound { none, lower, upper };

/// Whether a value stands on one of its bounds, to 1e-6 of their distance; exactly where only one is finite.
/// In the unit of the number [any].
[[nodiscard]] AtBound at_bound(double value, double lower, double upper);

/// The 95 % interval of a fitted number as the command says it: "[1, 2]", "[1, unbounded]", "not determined
/// by the readings", and the bound on which the number stands. Ends in the number's unit.
[[nodiscard]] std::string interval_words(std::optional<double> lower, std::optional<double> upper,
                                         bool identified, AtBound bound);

/// A force or a length in another unit than the file says: readings times `factor` are in the file's unit.
struct UnitSlip {
  double factor = 1.0;
  const char* force = "";   ///< words for forces; empty: no such slip
  const char* travel = "";  ///< words for displacements; empty: no such slip
};

/// The slips that are looked for, both ways: kgf, gf and lbf for N, decimal multiples, inches for mm.
inline constexpr UnitSlip unit_slips[] = {
    {9.80665, "forces in kgf where N is declared", ""},
    {1.0 / 9.80665, "forces that were multiplied by 9.81 once too often", ""},
    {4.4482216, "forces in lbf where N is declared", ""},
    {9.80665e-3, "forces in gf where N is declared", ""},
    {1e3, "forces in kN where N is declared", "displacements in m where mm is declared"},
    {1e-3, "forces in mN where N is declared", "displacements in um where mm is declared"},
    {25.4, "a factor of 25.4 between inch and mm", "displacements in inches where mm is declared"},
    {1.0 / 25.4, "a factor of 25.4 between inch and mm", "displacements in mm that were multiplied by 25.4"},
    {10.0, "", "displacements in cm where mm is declared"}};

}  // namespace snare::identification
