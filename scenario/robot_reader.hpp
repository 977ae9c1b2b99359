#pragma once

#include "scenario/composition.hpp"

namespace snare::scenario {

/// Tables `robot` of driven bodies: behind all contacts, which they name.
void read_robots(Composition& composition);

}  // namespace snare::scenario
