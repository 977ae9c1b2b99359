#pragma once

#include "coupling/statics/push_problem.hpp"

#include <string>

namespace snare::scenario {

/// Returns a push as the tables `[wire]`, `[mount]`, `[pusher]`, `[bulge]` and `[gravity]` of a file, keys
/// and units as in docs/experiment_file.md; read_push_problem() reads them as this push, to one part in 2^52
/// of every number. Keys that have their default are left out, except those that must be given and the
/// stiffnesses EI and EA, which are always written. Contact position and travel are left to the caller. A
/// profile of the bending stiffness has no key and is left out.
[[nodiscard]] std::string push_tables_text(const coupling::PushProblem& push);

}  // namespace snare::scenario
