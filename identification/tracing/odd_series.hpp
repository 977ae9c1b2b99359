#pragma once

#include "identification/fitting/finding.hpp"
#include "identification/tracing/progress.hpp"
#include "identification/tracing/residual_tests.hpp"

#include <optional>

namespace snare::identification {

/// Finds the one series whose removal lets the base model explain the others to their noise, if it is of
/// another wire: with its own stiffnesses it is explained, too, and better than with its own zero, place,
/// length, gain or offset. None if no series or several qualify, and with fewer than three. base: fit of all
/// series.                                                                                   theory.md (I.36)
[[nodiscard]] std::optional<Finding> series_of_another_specimen(const Model& model, const Data& data,
                                                                const Fit& base, Progress& progress);

/// Finds the two series that the base model explains, with all others, to their noise where each has the
/// place and the mounts of the other: their files are exchanged. None where no exchange does. base: fit of
/// all series.
[[nodiscard]] std::optional<Finding> series_exchanged(const Model& model, const Data& data, const Fit& base,
                                                      Progress& progress);

}  // namespace snare::identification
