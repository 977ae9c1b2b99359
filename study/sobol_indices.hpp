#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace snare::study {

/// Share of the variance of a result that is due to one variable.                            theory.md (S.4)
struct SobolIndex {
  double first = 0.0;                         ///< by itself
  double total = 0.0;                         ///< by itself and with others
  double first_half = 0.0, total_half = 0.0;  ///< half of the 95 % interval, by the scatter of the replicates
};

/// Independently shifted replicates of which the rows of a sensitivity design consist: row i belongs to i
/// modulo this.
inline constexpr std::uint64_t sobol_replicates = 8;

/// Below it a few rare results decide, and intervals would be too narrow.
inline constexpr double least_effective_rows = 10.0;

/// Indices of all variables, with what they were computed from.
struct SobolIndices {
  /// One a variable; empty below two replicates with whole rows and below least_effective_rows.
  std::vector<SobolIndex> of;
  double mean = 0.0;            ///< of the field, in its unit
  double variance = 0.0;        ///< of the field, in its unit squared
  double effective_rows = 0.0;  ///< rows, as many as equal shares would need, of which the variance consists
  std::uint64_t rows = 0;       ///< that were used
  std::uint64_t dropped = 0;    ///< in which a case has no result
};

/// From the cases of a sensitivity design. first: Saltelli et al. 2010, (b) of Table 2, or of rare outcomes
/// Jansen 1999; total: Jansen; intervals by Student's t over the replicates. result: of a case, asked twice
/// in ascending order; only sums are kept. In the field's unit.
[[nodiscard]] SobolIndices sobol_indices(
    std::size_t variables, std::uint64_t rows,
    const std::function<std::optional<double>(std::uint64_t index)>& result);

}  // namespace snare::study
