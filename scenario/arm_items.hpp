#pragma once

#include "scenario/composition.hpp"

namespace snare::scenario {

/// `[[arms]]`: adds them to the composition, to be placed with all else.
void read_arms(Composition& composition);

}  // namespace snare::scenario
