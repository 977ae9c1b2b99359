#pragma once

#include "identification/records/record_data.hpp"

namespace snare::identification {

/// Nelder and Mead's simplex (NLopt), from the settings of `fit`, which it replaces. The first simplex is a
/// scale of every number wide (ten times where the number is declared), the end is where chi2 or all numbers
/// change by less than the tolerance: Honda et al. (2014) stop in this way. Bounds are kept.
void nelder_mead(const RecordModel& model, const RecordData& data, const RecordFitOptions& options,
                 RecordFit& fit);

}  // namespace snare::identification
