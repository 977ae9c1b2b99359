#include "coupling/statics/path_follower.hpp"

#include <cmath>

namespace snare::coupling {

numerics::SolveReport follow(FollowedPath& path, double target, const StepControl& control) {
  // A remainder shorter than a tenth of the step is taken with it: points too near each other spoil a predictor.
  constexpr double with_remainder = 1.1;
  constexpr double to_event = 1.000001;  // not beyond it
  double step = target - path.parameter();
  double stretch = with_remainder;
  numerics::SolveReport report;
  while (path.parameter() != target) {
    if (control.stop && control.stop()) return report.end(numerics::Termination::interrupted, "interrupted");
    const double from = path.parameter();
    const double rest = target - from;
    if (std::abs(step) > std::abs(rest) || step * rest <= 0.0) step = rest;
    const double next = stretch * std::abs(step) >= std::abs(rest) ? target : from + step;
    const double length = control.measure == StepMeasure::attempted ? next - from : step;
    stretch = with_remainder;
    const StepOutcome outcome = path.step_to(next);
    report = outcome.report;
    switch (outcome.kind) {
      case StepOutcome::Kind::taken:
        step = 2.0 * length;
        break;
      case StepOutcome::Kind::event:
        step = outcome.fraction * length;
        stretch = to_event;
        break;
      case StepOutcome::Kind::elsewhere:
        step = target - path.parameter();
        break;
      case StepOutcome::Kind::failed:
        step = 0.5 * length;
        if (std::abs(step) < control.smallest_step) return path.without_steps(target, report);
        break;
      case StepOutcome::Kind::stopped:
        return report;
    }
  }
  return report;
}

}  // namespace snare::coupling
