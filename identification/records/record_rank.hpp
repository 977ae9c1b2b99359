#pragma once

#include "identification/records/record_data.hpp"

namespace snare::identification {

/// Fills `rank` of a usable fit with central derivatives, whose errors those by twice the step show, and
/// `lower` where chi2 falls beside the answer. With null directions the covariance becomes that with one
/// number of each held.                                                                     theory.md (I.32)
void find_rank(const RecordModel& model, const RecordData& data, RecordFit& fit);

}  // namespace snare::identification
