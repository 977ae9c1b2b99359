#include "coupling/statics/push_solver.hpp"

#include "coupling/statics/planar_push.hpp"
#include "coupling/statics/push_setup.hpp"
#include "coupling/statics/spatial_push.hpp"

#include <utility>

namespace snare::coupling {

bool differentiable(const PushProblem& test) {
  return !needs_space(test);
}

PushCurve solve_push(const PushProblem& test, const PushOptions& options, int coarsening) {
  if (needs_space(test)) return solve_spatial_push(test, options, coarsening);
  PushSetup setup = prepare_push(test, options.elements, options.grading, coarsening);
  if (!setup.report.usable()) {
    PushCurve curve;
    curve.report = setup.report;
    return curve;
  }
  return PlanarPush(std::move(setup), test, options).run(test.travel);
}

}  // namespace snare::coupling
