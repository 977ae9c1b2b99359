#pragma once

#include <cstdint>

namespace snare::study {

/// An interval of probabilities.
struct ProbabilityInterval {
  double low = 0.0;   ///< share
  double high = 1.0;  ///< share
};

/// 95 % interval of a probability from `hits` in `cases` independent trials (Clopper, Pearson 1934): never
/// shorter than it says. theory.md (S.3). [0, 1] where there are no cases.
[[nodiscard]] ProbabilityInterval proportion_interval(std::uint64_t hits, std::uint64_t cases);

}  // namespace snare::study
