#pragma once

#include "coupling/dynamics/model.hpp"
#include "coupling/dynamics/options.hpp"

namespace snare::coupling {

/// Throws InputError with everything that is wrong in a motion or its options.
void require_valid(const Motion& motion, const MotionOptions& options);

}  // namespace snare::coupling
