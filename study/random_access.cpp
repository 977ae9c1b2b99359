#include "study/random_access.hpp"

#include <bit>
#include <cassert>

namespace snare::study {

namespace {

std::uint64_t mixed(std::uint64_t x) noexcept {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30u)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27u)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31u);
}

}  // namespace

double hashed_uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) noexcept {
  const std::uint64_t bits = mixed(mixed(mixed(seed) ^ stream) ^ index) >> 11u;  // 53 of them
  return (static_cast<double>(bits) + 0.5) * 0x1p-53;
}

KeyedPermutation::KeyedPermutation(std::uint64_t seed, std::uint64_t stream, std::uint64_t size) noexcept
    : key_(mixed(mixed(seed) ^ ~stream)), size_(size) {
  assert(size > 0);
  const auto bits = static_cast<unsigned>(std::bit_width(size - 1));
  half_bits_ = bits < 2 ? 1 : (bits + 1) / 2;
}

std::uint64_t KeyedPermutation::operator()(std::uint64_t index) const noexcept {
  constexpr std::uint64_t rounds = 4;
  const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
  do {  // at most four times on average: the network permutes less than four times as many numbers
    std::uint64_t left = index >> half_bits_;
    std::uint64_t right = index & mask;
    for (std::uint64_t r = 0; r < rounds; ++r) {
      const std::uint64_t next = left ^ (mixed(key_ ^ mixed(right + (r << 58u))) & mask);
      left = right;
      right = next;
    }
    index = (left << half_bits_) | right;
  } while (index >= size_);
  return index;
}

}  // namespace snare::study
