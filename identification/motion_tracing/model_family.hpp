#pragma once

#include "identification/motion_tracing/record_trace.hpp"

#include <functional>
#include <string>
#include <vector>

namespace snare::identification {

/// The base fit once more under other keys, RecordSet::families: what another kind of model takes the same
/// numbers for.
/// scales: by which the channels are weighed, as for the base, in the unit of each channel. progress: false
/// stops, and the families that are done come back.
[[nodiscard]] std::vector<ModelFamily> fit_families(
    const RecordSet& set, const ChannelScales& scales, const std::vector<RecordSetting>& base,
    const std::function<bool(int iteration, double chi2)>& progress);

/// Numbers that both show and of which a family's value lies outside the interval of 95 % of the base, or its
/// interval does not hold that of the
/// base: a sentence each. Such a difference is one between models, which no interval of a fit holds.
[[nodiscard]] std::vector<std::string> family_differences(const std::vector<TracedNumber>& base,
                                                          const std::vector<ModelFamily>& families);

}  // namespace snare::identification
