#pragma once

#include "coupling/statics/push_curve.hpp"
#include "coupling/statics/push_options.hpp"
#include "coupling/statics/push_problem.hpp"

namespace snare::coupling {

/// Whether a test leaves the plane of the wire: a tilted pusher, or weight across the plane.
[[nodiscard]] bool needs_space(const PushProblem& test);

/// The push by a tilted pin: like solve_push, for contact at a point between clamps or pins that do not slip.
/// Without friction a loose wire swings freely about its chord; the path starts where it has swung so that
/// the pin's force has no moment about the chord.
[[nodiscard]] PushCurve solve_spatial_push(const PushProblem& test, const PushOptions& options,
                                           int coarsening);

}  // namespace snare::coupling
