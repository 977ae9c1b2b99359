#pragma once

#include "identification/fitting/finding.hpp"
#include "identification/tracing/progress.hpp"
#include "identification/tracing/residual_tests.hpp"

#include <optional>

namespace snare::identification {

/// The one series without which the base model explains the others to the noise, where what sets it apart is the wire: with
/// stiffnesses of its own it is explained, too, and better than with a zero, a place, a length or a gain of its own. None where
/// no series or more than one is such, and with fewer than three. base: fit of all.               theory.md (I.36)
[[nodiscard]] std::optional<Finding> series_of_another_specimen(const Model& model, const Data& data, const Fit& base,
                                                                Progress& progress);

}  // namespace snare::identification
