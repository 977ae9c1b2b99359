#pragma once

#include "identification/motion_tracing/record_round.hpp"

namespace snare::identification {

/// The fit of the beginnings of the records, an eighth, a fourth, a half, and of the whole, each from what
/// the one before it has found.
[[nodiscard]] RecordFit fit_from_beginnings(const RecordModel& model, const RecordData& data,
                                            const std::vector<RecordSetting>& start,
                                            const RecordFitOptions& options);

/// A pass over the catalogue with the beginnings of the records alone: a thirty-second of them, a sixteenth,
/// ... a half. Of the class that one of them names each member is fitted to the whole records; the one that
/// leaves least there counts, if that is at most a half of the sum of squares, and the first that is in step
/// with them ends the search. `start`: the fitted numbers, from which each of the passes begins. Without such
/// an effect nothing is added. A share of which a piece would have fewer than 20 readings is not asked.
///                                                                                           theory.md (I.29)
[[nodiscard]] RoundResult round_from_beginnings(const RoundInput& input,
                                                const std::vector<RecordSetting>& start);

}  // namespace snare::identification
