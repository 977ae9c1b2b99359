#pragma once

#include "identification/fitting/prediction.hpp"

#include <cstddef>
#include <vector>

namespace snare::identification {

/// Series whose curves are one and the same, as indices, every series in one group: dense records of a push
/// in one direction on the same wire, read alike, which one solve serves. declared: as the file gives them,
/// from which numbers count; applied, reading: with a model's settings, one a series.
[[nodiscard]] std::vector<std::vector<std::size_t>> shared_pushes(const std::vector<Series>& declared,
                                                                  const std::vector<Series>& applied,
                                                                  const std::vector<ReadingModel>& reading);

/// One series with the displacements of all of a group, in their order.
[[nodiscard]] Series merged(const std::vector<Series>& series, const std::vector<std::size_t>& group);

/// What a prediction of merged() says of one of them.
[[nodiscard]] Prediction part_of(const Prediction& whole, const Series& merged, const Series& one);

}  // namespace snare::identification
