#pragma once

#include "coupling/statics/push_problem.hpp"
#include "coupling/statics/push_system.hpp"
#include "numerics/report.hpp"

#include <memory>

namespace snare::coupling {

/// A wire between its mounts with the pusher at first touch: the start of every push.
struct PushSetup {
  std::unique_ptr<wire::PlanarRod> rod;
  std::unique_ptr<PushSystem> system;  ///< sliding[0] is the pusher, then the supports
  numerics::PathPoint start;           ///< travel 0, no force
  double natural_height = 0.0;         ///< of the wire where the pusher will touch it [m]
  int iterations = 0;
  numerics::SolveReport report;  ///< start is only meaningful when usable
};

/// The rod of a push test on a mesh, and the material coordinates of mounts and contact to begin with.
[[nodiscard]] wire::PlanarRodProperties rod_properties(const PushProblem& test);
[[nodiscard]] wire::Controls initial_controls(const PushProblem& test);

/// The pusher (and the supports) with the constants of the test, not in contact yet: the pusher's axis at the
/// height of the chord, or on the straight wire that rests on supports.
[[nodiscard]] std::vector<SlidingContact> make_contacts(const PushProblem& test,
                                                        const wire::MaterialMesh& mesh,
                                                        const wire::Controls& controls);

/// edges: a multiple of 4, >= 16; coarsening 1, 2 or 4: every, every second or every fourth vertex of that
/// mesh is used. grading < 0: chosen from the boundary layer sqrt(EI/T) at a strain of 0.5 %.
[[nodiscard]] PushSetup prepare_push(const PushProblem& test, int edges, double grading, int coarsening);

}  // namespace snare::coupling
