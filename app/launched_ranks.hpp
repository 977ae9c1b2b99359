#pragma once

#include "study/ranks.hpp"

#include <memory>

namespace snare::app {

/// The ranks of the mpirun that has started this process; null where none has. Throws std::runtime_error
/// where one has and this build has no MPI.
[[nodiscard]] std::unique_ptr<study::Ranks> launched_ranks();

}  // namespace snare::app
