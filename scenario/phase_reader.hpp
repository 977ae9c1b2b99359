#pragma once

#include "scenario/composition.hpp"

namespace snare::scenario {

/// `[[phases]]`: behind all that they may name.
void read_phases(Composition& composition);

}  // namespace snare::scenario
