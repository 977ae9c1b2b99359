#pragma once

#include "coupling/dynamics/run/simulate.hpp"

#include <vector>

namespace snare::test {

/// Everything that a sample has, to compare bits.
[[nodiscard]] std::vector<double> numbers(const coupling::MotionSample& s);

/// Runs a motion with checkpoints, and from each of them again: samples, unknowns, integrals, memory, steps,
/// events and extremes must be the same to the last bit. Returns the states of the checkpoints.
std::vector<coupling::MotionState> expect_same_bits_from_checkpoints(const coupling::Motion& motion,
                                                                     const coupling::MotionOptions& options);

}  // namespace snare::test
