#pragma once

#include "scenario/composition.hpp"

namespace snare::scenario {

/// `[[loads]]`: forces and moments over time on frames.
void read_loads(Composition& composition);

}  // namespace snare::scenario
