#pragma once

#include "identification/motion_tracing/motion_round.hpp"

namespace snare::identification {

/// The fit of the beginnings of the records, an eighth, a fourth, a half, and of the whole, each from what the one before it has found.
[[nodiscard]] MotionFit fit_from_beginnings(const MotionModel& model, const MotionData& data,
                                            const std::vector<MotionSetting>& start, const MotionFitOptions& options);

/// A pass over the catalogue with the beginnings of the records alone: a half of them, a fourth, an eighth, until one adds an effect that leaves of
/// the sum of squares of the whole records at most a half. `start`: the fitted numbers, from which each of them begins. Without such an effect nothing
/// is added. A share of which a piece would have fewer than 20 readings is not asked.
[[nodiscard]] RoundResult round_from_beginnings(const RoundInput& input, const std::vector<MotionSetting>& start);

}  // namespace snare::identification
