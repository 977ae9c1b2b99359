#pragma once

#include <array>
#include <cstddef>

namespace snare::wire {

/// The two ends of a wire; its arc length increases from left to right.
enum class End { left, right };

inline constexpr std::array<End, 2> ends{End::left, End::right};

/// Place of an end in an array of two.
[[nodiscard]] constexpr std::size_t index_of(End end) noexcept {
  return end == End::left ? 0 : 1;
}

}  // namespace snare::wire
