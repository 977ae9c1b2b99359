#pragma once

#include <cstdint>

namespace snare::study {

/// A number in (0, 1) [-] that depends on nothing but its arguments: row 137 of a design is known without the
/// 136 before it. 53 bits of SplitMix64 (Steele, Lea, Flood 2014) of the three, never 0 or 1.
[[nodiscard]] double hashed_uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) noexcept;

/// A permutation of 0 ... size - 1 of which every element is known without the others: four rounds of a
/// Feistel network on the least even number of bits that holds the size, walked on until the result is inside
/// (Black, Rogaway 2002).
class KeyedPermutation {
 public:
  /// size > 0, < 2^62.
  KeyedPermutation(std::uint64_t seed, std::uint64_t stream, std::uint64_t size) noexcept;
  /// index < size.
  [[nodiscard]] std::uint64_t operator()(std::uint64_t index) const noexcept;

 private:
  std::uint64_t key_;
  std::uint64_t size_;
  unsigned half_bits_;
};

}  // namespace snare::study
