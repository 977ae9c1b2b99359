#include "coupling/dynamics/run/simulate.hpp"

#include "base/index.hpp"
#include "coupling/dynamics/run/check.hpp"
#include "coupling/dynamics/run/run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace snare::coupling {

namespace {

/// The first checkpoint behind a time, or the end when none comes before it.
double next_stop(const MotionOptions& options, double time) {
  constexpr double round_off = 1e-9;  // of an interval
  if (!std::isfinite(options.checkpoint_interval)) return options.duration;
  // A leg that is shorter than what tells two times apart has no end.
  const double interval = std::max(options.checkpoint_interval, 4.0 * time_resolution(options.duration));
  const double stop = (std::floor(time / interval + round_off) + 1.0) * interval;
  return stop < options.duration - round_off * interval ? stop : options.duration;
}

}  // namespace

MotionResult simulate(const Motion& motion, const MotionOptions& options, const MotionObserver& observer,
                      const MotionState* from, const MotionKeeper& keeper) {
  require_valid(motion, options);
  std::optional<MotionState> state;
  if (from != nullptr) state = *from;
  // Every leg between two checkpoints is a run of its own that knows the state alone: whether the legs are
  // those of one process or of several makes no difference.
  for (;;) {
    MotionRun run(motion, options, observer);
    if (state) {
      run.resume(*state);
    } else {
      run.begin();
    }
    const double stop = next_stop(options, state ? state->time : 0.0);
    MotionResult result = run.run_until(stop);
    const bool over = !result.phases.empty() && motion.phases[base::at(result.phases.back().phase)].ends_run;
    if (over || !result.report.usable() || !reached(result.report.time, stop) || stop >= options.duration)
      return result;
    state = std::move(result.last);
    if (keeper) keeper(*state);
  }
}

}  // namespace snare::coupling
