#pragma once

#include "identification/fitting/finding.hpp"
#include "identification/fitting/least_squares.hpp"

#include <vector>

namespace snare::identification {

/// Series whose readings have the other sign: travels that go below zero only, and forces of which four in
/// five are against those of the declared model. declared: the model's forces [N], one vector a series, empty
/// where they are not known.
/// series: with readings.
[[nodiscard]] std::vector<Finding> sign_findings(const std::vector<Series>& series,
                                                 const std::vector<std::vector<double>>& declared,
                                                 const SolverSettings& solver);

/// Slips of units. A push is homogeneous of first degree in its stiffnesses: all fitted ones at one factor
/// from their declared values look like forces in another unit. Where a stiffness ends on its bound, or the
/// fit leaves a twentieth of the largest force, the readings are fitted again in the units of `unit_slips`,
/// and the one that leaves a fifth of chi2 and stiffnesses near the declared ones is reported. base: the fit
/// of `data`, readings and not published fits.
[[nodiscard]] std::vector<Finding> unit_findings(const Model& model, const Data& data, const Fit& base);

}  // namespace snare::identification
