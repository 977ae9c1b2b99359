#pragma once

#include "numerics/report.hpp"

#include <functional>

namespace snare::coupling {

/// What became of one step along a path of equilibria.
struct StepOutcome {
  enum class Kind {
    taken,      ///< the point at the asked parameter is accepted
    event,      ///< something happens inside the step; nothing is accepted, the next step goes to just there
    elsewhere,  ///< the state is on another part of the path now (lift-off, another branch): on from there
    failed,     ///< not solved and nothing accepted: a shorter step may be
    stopped     ///< the path ends here, for the reason that the report gives
  };
  Kind kind = Kind::taken;
  numerics::SolveReport report{};
  double fraction = 1.0;  ///< of an event: how far into the step it happens, in (0, 1) [-]
};

/// A path of equilibria as its follower sees it: a parameter, and a solution at the next value of it.
/// What the steps leave behind (points, events, friction's memory) is the path's own.
class FollowedPath {
 public:
  virtual ~FollowedPath() = default;
  /// Of the last accepted point, in the parameter's own unit (a push: its travel [m]).
  [[nodiscard]] virtual double parameter() const = 0;
  /// Solves at a value of the parameter, in its unit, and accepts the solution, or puts everything back.
  [[nodiscard]] virtual StepOutcome step_to(double parameter) = 0;
  /// The steps towards `target`, in the parameter's unit, have become too small, `last` is why the last one failed: reaches the target
  /// in another way, or says why the path ends.
  [[nodiscard]] virtual numerics::SolveReport without_steps(double target, const numerics::SolveReport& last) = 0;
};

/// Of which length the next step is the double, or after a failure the half. The two differ by round-off, and at the
/// target by the remainder that is taken with the last step; the points that a path passes depend on it.
enum class StepMeasure {
  attempted,  ///< the distance between the two values of the parameter
  planned     ///< the step before a remainder was added
};

/// How a path is followed: by which measure steps grow, how small they may become, and who may end it.
struct StepControl {
  double smallest_step = 1e-9;  ///< of the parameter, in its unit: a failed step is not halved below it
  StepMeasure measure = StepMeasure::attempted;
  std::function<bool()> stop = {};  ///< asked before every step; true: the path ends here, interrupted. May be empty
};

/// Follows a path to a target, first in one step; a step that fails is halved, one that succeeds is doubled, one with
/// an event inside ends there. target: in the parameter's unit. Returns the report of the last step, usable when the target is reached.
[[nodiscard]] numerics::SolveReport follow(FollowedPath& path, double target, const StepControl& control);

}  // namespace snare::coupling
