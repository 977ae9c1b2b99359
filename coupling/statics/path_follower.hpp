#pragma once

#include "numerics/report.hpp"

#include <Eigen/Core>

#include <functional>
#include <limits>

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
  /// The steps towards `target`, in the parameter's unit, have become too small, `last` is why the last one
  /// failed: reaches the target in another way, or says why the path ends.
  [[nodiscard]] virtual numerics::SolveReport without_steps(double target,
                                                            const numerics::SolveReport& last) = 0;
};

/// Of which length the next step is the double, or after a failure the half. The two differ by round-off, and
/// at the target by the remainder that is taken with the last step; the points that a path passes depend on
/// it.
enum class StepMeasure {
  attempted,  ///< the distance between the two values of the parameter
  planned     ///< the step before a remainder was added
};

/// How a path is followed: by which measure steps grow, how small they may become, and who may end it.
struct StepControl {
  double smallest_step = 1e-9;  ///< of the parameter, in its unit: a failed step is not halved below it
  StepMeasure measure = StepMeasure::attempted;
  std::function<bool()> stop =
      {};  ///< asked before every step; true: the path ends here, interrupted. May be empty
  double largest_step = std::numeric_limits<double>::infinity();  ///< of the parameter, in its unit
};

/// Follows a path to a target, first in one step; a step that fails is halved, one that succeeds is doubled,
/// one with an event inside ends there; none is longer than the largest. target: in the parameter's unit.
/// Returns the report of the last step, usable when the target is reached.
[[nodiscard]] numerics::SolveReport follow(FollowedPath& path, double target, const StepControl& control);

/// A path whose states depend on the steps that led to them (friction, slip, sliders of a section).
class RememberingPath : public FollowedPath {
 public:
  /// Keeps the present state, memory included. Calling the result puts it back, as often as wanted while the
  /// path lives.
  [[nodiscard]] virtual std::function<void()> checkpoint() = 0;
  /// Like step_to, in the parameter's unit, for a step that is taken back when its measures are known:
  /// nothing else of it is needed.
  [[nodiscard]] virtual StepOutcome try_step_to(double parameter) { return step_to(parameter); }

  /// Values at the last accepted point that measure the error of a step, and the error allowed for each, in
  /// its unit.
  struct Measures {
    Eigen::VectorXd values;
    Eigen::VectorXd allowed;
  };
  [[nodiscard]] virtual Measures measures() = 0;
};

/// Steps that a path with a memory chooses by itself, whatever points are asked for.          theory.md (N.9)
///
/// Every step is taken at once and in two halves. The difference estimates the error of the halves, whose
/// path is kept: a method of first order errs by c h^2 in a whole step and by c h^2 / 2 in two halves. A step
/// whose error is larger than allowed is repeated; the next is as long as the error admits, up to twice the
/// last.
class OwnSteps {
 public:
  /// Lengths of the parameter, in its unit.
  struct Lengths {
    double first = 0.0;     ///< of the first step, and of the first after a turn
    double finest = 0.0;    ///< a step below it is taken at once, whatever its error
    double smallest = 0.0;  ///< a step that fails is not halved below it
    double largest = 0.0;
  };
  /// Called after each accepted step, with its two ends. back: puts the path to the beginning of the step.
  /// The callee must leave the path in the state in which it found it.
  using Accepted =
      std::function<numerics::SolveReport(double from, double to, const std::function<void()>& back)>;

  explicit OwnSteps(const Lengths& lengths) : lengths_(lengths), step_(lengths.first) {}

  /// Begins with a short step again: the path turns back.
  void turn() { step_ = lengths_.first; }
  /// Goes on towards `target`, in the parameter's unit, by one step and its halves, and not beyond. The
  /// report is usable when the path has come on; else the path stands where it stood, and either ends there
  /// or takes no step of any length.
  [[nodiscard]] numerics::SolveReport advance(RememberingPath& path, double target, const Accepted& accepted);

 private:
  /// Sets the length after a step that was not taken; false: the report of the outcome ends the path.
  [[nodiscard]] bool shorten(const StepOutcome& outcome, double length);

  Lengths lengths_;
  double step_;           // length of the next
  double resumed_ = 0.0;  // after an event; 0: the next step does not end at one
};

}  // namespace snare::coupling
