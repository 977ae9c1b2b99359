#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/options.hpp"

namespace snare::coupling {

/// Throws InputError with everything that is wrong in a motion or its options.
void require_valid(const Motion& motion, const MotionOptions& options);

}  // namespace snare::coupling
