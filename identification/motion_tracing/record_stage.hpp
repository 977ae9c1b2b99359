#pragma once

#include "identification/motion_tracing/record_trace.hpp"

#include <vector>

namespace snare::identification {

/// Standard errors either way of a 95 % interval of a normal quantity.
inline constexpr double half_width_95 = 1.96;

/// Everything that is said of one fitted model. heldout: data of the held-out records with their own fits.
[[nodiscard]] RecordStage record_stage(const RecordModel& model, const RecordData& data, const RecordFit& fit,
                                       const RecordFit* heldout, const RecordData& heldout_data);

/// Standard deviation of one reading of a channel, in its unit: declared; else of its white part, the median
/// of |y_(i-1) - 2 y_i + y_(i+1)| over 0.674 sqrt(6), which smooth motions hardly enter and jumps, as of a
/// drive that turns round, not at all. Where the median is zero, the mean square.
[[nodiscard]] double reading_sigma(const RecordSet& set, const std::string& sensor);

/// Numbers of a fit with their intervals.
[[nodiscard]] std::vector<TracedNumber> traced_numbers(const RecordModel& model, const RecordFit& fit);

}  // namespace snare::identification
