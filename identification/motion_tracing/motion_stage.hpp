#pragma once

#include "identification/motion_tracing/motion_trace.hpp"

#include <vector>

namespace snare::identification {

/// Everything that is said of one fitted model. heldout: data of the held-out records with their own fits.
[[nodiscard]] MotionStage motion_stage(const MotionModel& model, const MotionData& data, const MotionFit& fit,
                                       const MotionFit* heldout, const MotionData& heldout_data);

/// Standard deviation of one reading of a channel: declared; else of its white part, from second differences of the readings,
/// sum (y_(i-1) - 2 y_i + y_(i+1))^2 / (6 n), which smooth motions hardly enter.
[[nodiscard]] double reading_sigma(const RecordSet& set, const std::string& sensor);

/// Numbers of a fit with their intervals.
[[nodiscard]] std::vector<TracedNumber> traced_numbers(const MotionFit& fit);

}  // namespace snare::identification
