#pragma once

#include "coupling/statics/path_follower.hpp"
#include "coupling/statics/push_curve.hpp"
#include "coupling/statics/push_options.hpp"
#include "numerics/path.hpp"

#include <string>
#include <vector>

namespace snare::coupling {

/// A push, its travel the parameter of a path of equilibria: what a push in the plane and one in space share.
class PushPath : public FollowedPath {
 public:
  /// From first touch through the asked travels [m], in their order.
  [[nodiscard]] PushCurve run(const std::vector<double>& travel);

  [[nodiscard]] double parameter() const override { return point_.parameter; }

 protected:
  PushPath(const PushOptions& options, StepMeasure measure)
      : options_(options), control_{options.smallest_step, measure, options.stop} {}

  /// Brings the wire to first touch.
  [[nodiscard]] virtual numerics::SolveReport start() = 0;
  /// Adds the accepted point to the curve.
  virtual void record(double travel) = 0;
  /// Adds the point of first touch without a solution there; false: it is solved like every other.
  [[nodiscard]] virtual bool record_touch() { return false; }
  [[nodiscard]] virtual numerics::SolveReport interrupted() const;

  /// Why the push ends at the accepted point.
  [[nodiscard]] numerics::SolveReport ended(numerics::Termination termination, const std::string& message) const;
  [[nodiscard]] numerics::SolveReport follow_to(double target) { return follow(*this, target, control_); }
  void note(PushEvent::Kind kind) { curve_.events.push_back({kind, point_.parameter}); }
  /// Adds a point with the iterations since the one before. One with a number that is none is not added and ends the run.
  void add(PushPoint point);

  const PushOptions& options_;
  numerics::PathPoint point_;  // last accepted
  PushCurve curve_;
  int iterations_ = 0;       // since the last point of the curve
  bool not_finite_ = false;  // a point was not added

 private:
  StepControl control_;
};

}  // namespace snare::coupling
