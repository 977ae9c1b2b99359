#pragma once

#include "identification/fitting/least_squares.hpp"
#include "identification/tracing/progress.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// Fits the declared model by the numbers `free` (keys; none: those that the experiment names, else the two
/// stiffnesses). Throws base::InputError for unknown keys, thresholds that the declared model does not have, too few
/// readings. Gives unit noise to data of unknown noise.
[[nodiscard]] Fit fit_base(const Experiment& experiment, const std::vector<std::string>& free, const Model& model,
                           Data& data, Progress& progress);

/// Where the noise is not known before a fit: takes it from the residual and fits again.    theory.md (I.3)
void settle_noise(const Model& model, Data& data, Fit& base);

}  // namespace snare::identification
