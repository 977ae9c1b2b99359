#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/options.hpp"
#include "coupling/dynamics/model/result.hpp"

#include <functional>

namespace snare::coupling {

/// Called at every checkpoint, with what to go on from.
using MotionKeeper = std::function<void(const MotionState&)>;

/// Integrates a motion.                                                     theory.md (M.1)-(M.17)
/// Wrong numbers throw InputError with all of them. A failure of the integration is in `report`; the rest is
/// what was reached.
/// from: continue from there instead of from the start; of the same motion (other forces and courses of its
/// bodies are allowed). Sums, events and samples go on too. From a checkpoint the result has the same bits as
/// without the stop.
[[nodiscard]] MotionResult simulate(const Motion& motion, const MotionOptions& options,
                                    const MotionObserver& observer = {}, const MotionState* from = nullptr,
                                    const MotionKeeper& keeper = {});

}  // namespace snare::coupling
