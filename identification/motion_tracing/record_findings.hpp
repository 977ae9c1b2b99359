#pragma once

#include "identification/motion_tracing/record_trace.hpp"

#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// Sensors whose readings have the other sign than a prediction, or are a unit's factor times it: with the
/// other sign, or times the factor, they follow it to a fifth of their standard deviation. predictions: of
/// the records of `data`, of several models; may hold none.
[[nodiscard]] std::vector<Finding> channel_findings(
    const RecordData& data, const std::vector<const std::vector<RecordPrediction>*>& predictions);

/// Numbers that stand on a bound, that the records leave open, or that are a unit's factor times their
/// declared values.
/// settings: of the numbers, with what is declared.
[[nodiscard]] std::vector<Finding> number_findings(const RecordStage& stage,
                                                   const std::vector<RecordSetting>& settings);

/// A warning where find_rank() has met a clearly lower sum of squares near the answer of a fit; else none.
[[nodiscard]] std::optional<std::string> lower_minimum(const RecordModel& model, const RecordFit& fit,
                                                       FitMethod method);

}  // namespace snare::identification
