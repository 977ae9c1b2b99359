#pragma once

#include "coupling/statics/path_follower.hpp"
#include "coupling/statics/push_curve.hpp"
#include "coupling/statics/push_options.hpp"
#include "coupling/statics/push_problem.hpp"
#include "numerics/path.hpp"

#include <optional>
#include <string>
#include <vector>

namespace snare::coupling {

/// Whether an equilibrium depends on earlier ones: by friction, slip of a mount, or sliders of a section.
[[nodiscard]] bool remembers(const PushProblem& test);

/// A push, its travel the parameter of a path of equilibria: what a push in the plane and one in space share.
///
/// Where an equilibrium depends on the steps that led to it (friction, slip, sliders of a section, the choice
/// of a branch), the path takes steps of its own (OwnSteps), or those that are given, from one turning point
/// of the asked travels to the next. A point that is asked for inside a step is solved from the step's
/// beginning and forgotten: the path and its other points do not depend on it. All other paths take the asked
/// points as their steps.
class PushPath : public RememberingPath {
 public:
  /// From first touch through the asked travels [m], in their order.
  [[nodiscard]] PushCurve run(const std::vector<double>& travel);

  [[nodiscard]] double parameter() const override { return point_.parameter; }

 protected:
  PushPath(const PushProblem& test, const PushOptions& options, StepMeasure measure);

  /// Brings the wire to first touch.
  [[nodiscard]] virtual numerics::SolveReport start() = 0;
  /// Adds the accepted point to the curve.
  virtual void record(double travel) = 0;
  /// Adds the point of first touch without a solution there; false: it is solved like every other.
  [[nodiscard]] virtual bool record_touch() { return false; }
  [[nodiscard]] virtual numerics::SolveReport interrupted() const;

  /// Why the push ends at the accepted point.
  [[nodiscard]] numerics::SolveReport ended(numerics::Termination termination,
                                            const std::string& message) const;
  [[nodiscard]] numerics::SolveReport follow_to(double target) { return follow(*this, target, control_); }
  void note(PushEvent::Kind kind) { curve_.events.push_back({kind, point_.parameter}); }
  /// Adds a point with the iterations since the one before. One with a value that is not a number is not
  /// added and ends the run.
  void add(PushPoint point);

  const PushOptions& options_;
  const double span_;          // of the mounts [m]
  const bool own_steps_;       // an equilibrium depends on the steps that led to it
  numerics::PathPoint point_;  // last accepted
  PushCurve curve_;
  int iterations_ = 0;       // since the last point of the curve
  bool not_finite_ = false;  // a point was not added

 private:
  [[nodiscard]] numerics::SolveReport through_points(const std::vector<double>& travel);
  [[nodiscard]] numerics::SolveReport by_own_steps(const std::vector<double>& travel);
  /// Follows the path to an asked travel and records it there, as does the next where the path stands there
  /// already.
  [[nodiscard]] numerics::SolveReport ask(double travel);
  [[nodiscard]] numerics::SolveReport record_here(double travel);

  /// Where the given steps have the next one end, in the present leg; none: they lead no further.
  [[nodiscard]] std::optional<double> given_end(double leg_end) const;

  StepControl control_;
  OwnSteps::Lengths lengths_;
};

}  // namespace snare::coupling
