#pragma once

#include "coupling/statics/contact_switch.hpp"
#include "coupling/statics/push_path.hpp"
#include "coupling/statics/push_sensitivity.hpp"
#include "coupling/statics/push_setup.hpp"

#include <deque>
#include <functional>
#include <optional>
#include <string>

namespace snare::coupling {

/// A push in the plane of the wire, with its contact states, folds, bifurcations and snaps.
/// theory.md (C.2)-(C.9)
class PlanarPush final : public PushPath {
 public:
  /// setup: usable.
  PlanarPush(PushSetup setup, const PushProblem& test, const PushOptions& options);

  [[nodiscard]] StepOutcome step_to(double travel) override;
  [[nodiscard]] StepOutcome try_step_to(double travel) override;
  /// Along the path's arc; not with a wrapped wire or a slipping mount, whose states would change on the way.
  [[nodiscard]] numerics::SolveReport without_steps(double target,
                                                    const numerics::SolveReport& last) override;
  [[nodiscard]] std::function<void()> checkpoint() override;
  [[nodiscard]] Measures measures() override;

 private:
  [[nodiscard]] numerics::SolveReport start() override;
  [[nodiscard]] numerics::SolveReport settle_mounts();
  void record(double travel) override;

  // Steps (planar_push.cpp).
  [[nodiscard]] numerics::PathPoint predict(double travel);
  [[nodiscard]] numerics::SolveReport solve(double travel);
  void accept(const ContactStates& before);
  /// Accepts a point that no step led to.
  void begin_again_at(const numerics::PathPoint& point);

  // Stability and other branches (planar_branches.cpp).
  [[nodiscard]] int count_unstable_modes();
  [[nodiscard]] numerics::PathPoint locate_bifurcation(const numerics::PathPoint& before, int modes_before);
  [[nodiscard]] bool leave_unstable_branch();
  [[nodiscard]] StepOutcome switch_branch(const numerics::PathPoint& beyond);
  [[nodiscard]] numerics::SolveReport lift_off(const ContactStates& before);
  [[nodiscard]] bool is_stable_without_pusher();
  [[nodiscard]] numerics::SolveReport snap_free_wire();
  [[nodiscard]] numerics::SolveReport follow_arc(double target);

  // What a point is asked for (planar_push.cpp).
  void differentiate(const numerics::PathPoint& at);
  [[nodiscard]] double viscous_stiffness();
  void keep_shape(double travel);

  PushSetup setup_;
  PushSystem& system_;
  double torsional_stiffness_;
  std::deque<numerics::PathPoint> past_;  // accepted ones with the same contact, newest last
  numerics::PathWorkspace workspace_;
  std::optional<PushSensitivity> sensitivity_;
  std::optional<double> differentiated_at_;
  bool settling_ = false;  // at first touch
  bool trying_ = false;    // a step that is taken back
  ContactMemory memory_;
  numerics::PathPoint trial_;
  numerics::PathPoint pressed_;  // last solution in which the pusher pressed
  // Parameter of the accepted point that the system was assembled at last
  std::optional<double> assembled_at_;
  int unstable_ = 0;
  int arcs_ = 0;  // that are under way, one within the other
  double dissipated_ = 0.0;
};

}  // namespace snare::coupling
