#pragma once

#include "identification/fitting/least_squares.hpp"
#include "identification/tracing/progress.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// Fits the declared model by the numbers `free` (keys; none: those that the experiment names, else the two
/// stiffnesses). Throws base::InputError for unknown keys, thresholds that the declared model does not have,
/// too few readings. Gives unit noise to data of unknown noise.
[[nodiscard]] Fit fit_base(const Experiment& experiment, const std::vector<std::string>& free,
                           const Model& model, Data& data, Progress& progress);

/// What the readings' errors are: the noise, where it is not known before a fit, from the residual, (I.3),
/// and that of places with a tolerance, (I.14). Fits again where either is new; the report of `base` says so
/// where that cannot be done.
void settle_noise(const Model& model, Data& data, Fit& base);

/// Where equilibria depend on earlier ones (friction, slip, yielding), chi2 has kinks, and a fit may end in
/// one. Fits readings again from half a standard error and a whole one to either side of every number, along
/// its valley, where chi2 rises by less than half of its rise in a smooth valley; takes the least chi2, until
/// that falls by less than 0.001.
void leave_kinks(const Model& model, const Data& data, Fit& base, Progress& progress);

}  // namespace snare::identification
