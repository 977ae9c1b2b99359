#pragma once

namespace snare::identification {

/// Standard deviation of the lost readings of published fits: one for all series, or one each with a normal
/// prior of its logarithm about the common one. theory.md (I.11)
enum class PublishedScatter { common, each };

/// Standard deviation of that prior [-]. Without a prior, numbers that act on one series alone can make the
/// likelihood infinite.
inline constexpr double scatter_spread = 0.3;

}  // namespace snare::identification
