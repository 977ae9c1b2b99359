#pragma once

#include "identification/fitting/experiment.hpp"
#include "identification/fitting/prediction.hpp"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace snare::app {

/// What a prediction has come to, series by series: what `snare push --json` prints, warnings aside.
[[nodiscard]] nlohmann::json push_json(const identification::Experiment& experiment,
                                       const std::vector<identification::Prediction>& predictions);

}  // namespace snare::app
