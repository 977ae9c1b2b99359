#pragma once

#include "scenario/composition.hpp"
#include "scenario/sensors.hpp"

#include <vector>

namespace snare::scenario {

/// `[[phases]]`: behind all that they may name, the sensors among it.
void read_phases(Composition& composition, const std::vector<Sensor>& sensors);

}  // namespace snare::scenario
