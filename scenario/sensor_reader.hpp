#pragma once

#include "scenario/composition.hpp"
#include "scenario/sensors.hpp"

#include <vector>

namespace snare::scenario {

/// `[[sensors]]`: behind all that they may name. output_interval: between two lines of the history [s].
[[nodiscard]] std::vector<Sensor> read_sensors(const Composition& composition, double output_interval);

}  // namespace snare::scenario
