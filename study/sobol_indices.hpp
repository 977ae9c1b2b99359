#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace snare::study {

/// Share of the variance of a result that is due to one variable.                            theory.md (S.4)
struct SobolIndex {
  double first = 0.0;                           ///< by itself
  double total = 0.0;                           ///< by itself and with others
  double first_error = 0.0, total_error = 0.0;  ///< standard errors, as if the rows were drawn independently
};

/// Indices of all variables, with what they were computed from.
struct SobolIndices {
  std::vector<SobolIndex> of;  ///< one a variable; empty where the variance is zero or less than two rows are whole
  double mean = 0.0;           ///< of the field, in its unit
  double variance = 0.0;       ///< of the field, in its unit squared
  std::uint64_t rows = 0;      ///< that were used
  std::uint64_t dropped = 0;   ///< in which a case has no result
};

/// From the cases of a sensitivity design. first: Saltelli et al. 2010, (b) of Table 2; total: Jansen 1999; errors by linear
/// propagation of the rows' scatter. result: of a case, asked twice in ascending order; only sums are kept. In the field's unit.
[[nodiscard]] SobolIndices sobol_indices(std::size_t variables, std::uint64_t rows,
                                         const std::function<std::optional<double>(std::uint64_t index)>& result);

}  // namespace snare::study
