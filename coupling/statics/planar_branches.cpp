#include "coupling/statics/contact_vertex.hpp"
#include "coupling/statics/planar_push.hpp"
#include "numerics/band_matrix.hpp"
#include "wire/statics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

// Where the path of a push in the plane turns unstable, folds, branches or ends.

namespace snare::coupling {

int PlanarPush::count_unstable_modes() {
  if (!workspace_.factored && workspace_.solver.factorize(workspace_.system)) workspace_.factored = true;
  if (!workspace_.solver.blockwise()) return unstable_;  // at a singular point the inertia is not known
  if (system_.sliding[0].status == ContactStatus::open) return workspace_.solver.negative_pivots();
  int count = workspace_.solver.negative_pivots();
  // Sliding: d2E/dS2 with the wire relaxed and the point of contact held must be positive as well.
  const SlidingContact& pusher = system_.sliding[0];
  const bool slides =
      pusher.status == ContactStatus::slip && !pusher.holds_material && pusher.friction == 0.0;
  if (slides && system_.sliding.size() == 1 && system_.mounts.empty()) {
    const Eigen::VectorXd& column = system_.rod_assembly().control_columns[1];
    const double stiffness =
        system_.rod_assembly().control_hessian(1, 1) - column.dot(workspace_.solver.solved_column(0));
    count += stiffness < 0.0 ? 1 : 0;
  }
  return count;
}

// The number of unstable modes changed between `before` and the accepted point while both were reached by
// ordinary steps: bisects for the travel where it does. Returns a point just beyond.
numerics::PathPoint PlanarPush::locate_bifurcation(const numerics::PathPoint& before, int modes_before) {
  assembled_at_.reset();
  numerics::PathPoint low = before;
  numerics::PathPoint high = point_;
  for (int k = 0; k < 24 && std::abs(high.parameter - low.parameter) > options_.smallest_step; ++k) {
    numerics::PathPoint middle{0.5 * (low.band + high.band), 0.5 * (low.border + high.border),
                               0.5 * (low.parameter + high.parameter)};
    const numerics::SolveReport report =
        numerics::correct(system_, middle, workspace_, options_.max_iterations);
    iterations_ += report.iterations;
    if (!report.usable()) break;
    (count_unstable_modes() == modes_before ? low : high) = middle;
  }
  curve_.events.push_back({PushEvent::Kind::bifurcation, 0.5 * (low.parameter + high.parameter)});
  return high;
}

// At an unstable point beyond a bifurcation: pushes the wire along its softest direction until Newton's
// method ends on another equilibrium that is stable.
bool PlanarPush::leave_unstable_branch() {
  assembled_at_.reset();
  numerics::PathPoint start = point_;
  const auto n = start.band.size();
  // Inverse iteration on the linearised equations.
  Eigen::VectorXd direction(n);
  for (Eigen::Index i = 0; i < n; ++i) direction[i] = std::sin(1.0 + 1.7 * static_cast<double>(i));
  system_.rod().clear_held(direction);
  system_.assemble(start, workspace_.system, workspace_.by_parameter);
  if (!workspace_.solver.factorize(workspace_.system)) return false;
  for (int k = 0; k < 6; ++k) {
    Eigen::VectorXd border = Eigen::VectorXd::Zero(start.border.size());
    workspace_.solver.solve(workspace_.system, direction, border);
    direction /= direction.lpNorm<Eigen::Infinity>();
  }
  // The same side on every mesh: the vertices move along the chord, from the left mount to the right one, on
  // the whole.
  double along = 0.0;
  for (Eigen::Index i = 0; i < n; i += wire::PlanarRod::block) along += direction[i];
  if (along < 0.0) direction = -direction;
  double size = 1e-4;
  for (int k = 0; k < 10; ++k, size *= 2.0) {
    for (const double sign : {1.0, -1.0}) {
      trial_ = start;
      trial_.band += sign * size * system_.length_scale() * direction;
      const numerics::SolveReport report = numerics::correct(system_, trial_, workspace_, 30);
      iterations_ += report.iterations;
      if (!report.usable() || count_unstable_modes() > 0) continue;
      if ((trial_.band - start.band).lpNorm<Eigen::Infinity>() < 1e-7 * system_.length_scale()) continue;
      begin_again_at(trial_);
      unstable_ = 0;
      return true;
    }
  }
  return false;
}

// Beyond a bifurcation: to the branch that is stable there.
StepOutcome PlanarPush::switch_branch(const numerics::PathPoint& beyond) {
  // Branches part slowly: leave a little beyond the crossing, else where the step ended.
  const numerics::PathPoint end = point_;
  const double ahead = 0.05 * (end.parameter - beyond.parameter);
  point_ = {beyond.band, beyond.border, beyond.parameter + ahead};
  bool left = numerics::correct(system_, point_, workspace_, options_.max_iterations).usable() &&
              leave_unstable_branch();
  if (!left) {
    point_ = end;
    left = leave_unstable_branch();
  }
  if (left) return {StepOutcome::Kind::elsewhere};
  return {StepOutcome::Kind::stopped,
          ended(numerics::Termination::step_too_small, "no stable branch was found beyond the bifurcation")};
}

// The pusher has come to where the wire leaves it (trial_, still pressed but without force).
numerics::SolveReport PlanarPush::lift_off(const ContactStates& before) {
  system_.sliding[0].status = ContactStatus::open;
  trial_.border.segment<2>(system_.pusher_rows().force).setZero();
  accept(before);
  assembled_at_.reset();
  if (!is_stable_without_pusher()) return snap_free_wire();
  accept(system_.contact_states());  // in equilibrium without the pusher's force
  assembled_at_.reset();
  unstable_ = 0;
  return {};
}

bool PlanarPush::is_stable_without_pusher() {
  const numerics::SolveReport report =
      numerics::correct(system_, trial_, workspace_, options_.max_iterations);
  iterations_ += report.iterations;
  if (!report.usable()) return false;
  numerics::BorderedSystem free;
  Eigen::VectorXd by_parameter;
  numerics::BandLdlt factor;
  system_.assemble(trial_, free, by_parameter);
  for (const numerics::BorderedSystem::Anchor& mount : free.anchors) free.matrix.hold(mount.band);
  return factor.factorize(free.matrix) && factor.negative_pivots() == 0;
}

// The wire has left the pusher in an unstable shape: it falls into a stable one, the pusher standing still. A
// perturbation away from the pusher decides the side; a small one first.
numerics::SolveReport PlanarPush::snap_free_wire() {
  assembled_at_.reset();
  const wire::PlanarState start = system_.state(point_);
  const int last = system_.rod().mesh().edges();
  const wire::PlanarRod held = system_.rod_with_held_mounts(point_);
  numerics::SolveReport worst;
  for (const double size : {1e-4, 1e-3, 1e-2, 5e-2}) {
    wire::PlanarState free = start;
    for (int i = 1; i < last; ++i) {
      const double bump = std::sin(std::numbers::pi * i / last);
      free.q.segment<2>(2 * i) += size * system_.length_scale() * bump * bump * system_.sliding[0].motion;
    }
    const wire::EquilibriumReport report = wire::find_equilibrium(held, free);
    iterations_ += report.iterations;
    worst = static_cast<const numerics::SolveReport&>(report);
    if (!report.usable()) continue;
    const ContactStates saved = system_.contact_states();
    trial_ = point_;
    trial_.band = free.q;
    if (!reseat_contact(system_, trial_, workspace_)) {
      system_.restore(saved);
      continue;
    }
    begin_again_at(trial_);
    note(PushEvent::Kind::snap);
    unstable_ = 0;
    return {};
  }
  return ended(worst.termination, worst.usable()
                                      ? "after the snap no equilibrium was found on this side of the pusher"
                                      : "the wire snapped and its new shape was not found");
}

// Natural steps have failed: a fold. Follows the path by its length (N.5) until it passes the target in its
// own direction of travel, recording the points on the way.
numerics::SolveReport PlanarPush::follow_arc(double target) {
  // An arc that ends where natural steps fail again begins the next one.
  constexpr int most_arcs = 64;
  struct Under {
    explicit Under(int& count) : count(++count) {}
    Under(const Under&) = delete;
    ~Under() { --count; }
    int& count;
  };
  const Under arc(arcs_);
  if (arcs_ > most_arcs) return ended(numerics::Termination::step_too_small, "the path cannot be followed");
  const double sense = target > point_.parameter ? 1.0 : -1.0;
  const std::optional<numerics::PathTangent> begin = numerics::tangent(system_, point_, workspace_, nullptr);
  if (!begin) return ended(numerics::Termination::singular_matrix, "the tangent matrix is singular");
  note(PushEvent::Kind::fold);
  numerics::PathTangent direction = *begin;
  if (direction.parameter * sense < 0.0) {
    direction.band = -direction.band;
    direction.border = -direction.border;
    direction.parameter = -direction.parameter;
  }
  const double length = system_.length_scale();
  double step = 1e-4 * length;
  for (int count = 0; count < 4000; ++count) {
    if (options_.stop && options_.stop()) return interrupted();
    const ContactStates saved = system_.contact_states();
    memory_.begin();
    numerics::SolveReport report = numerics::correct_along(system_, trial_ = point_, point_, direction, step,
                                                           workspace_, options_.max_iterations);
    iterations_ += report.iterations;
    if (!report.usable()) {
      system_.restore(saved);
      step *= 0.5;
      if (step < 1e-9 * length) return ended(report.termination, "the path cannot be followed");
      continue;
    }
    pressed_ = trial_;
    if (settle_contact(system_, trial_, memory_)) {
      const std::optional<double> at = memory_.event_fraction();
      const bool leaves = system_.sliding[0].status == ContactStatus::open;
      if (!leaves || (at && *at < 0.99 && step > 1e-9 * length)) {
        system_.restore(saved);
        step *= at ? std::clamp(*at, 0.01, 0.98) : 0.5;
        if (step < 1e-9 * length) {
          return ended(numerics::Termination::step_too_small, "the contact does not settle");
        }
        continue;
      }
      trial_ = pressed_;
      const numerics::SolveReport left = lift_off(saved);
      return left.usable() ? follow_to(target) : left;
    }
    const bool passed = (trial_.parameter - target) * sense >= 0.0;
    accept(saved);
    direction = numerics::tangent(system_, point_, workspace_, &direction).value_or(direction);
    // The factorisation of the tangent belongs to the accepted point.
    unstable_ = count_unstable_modes();
    if (passed && unstable_ == 0) {
      past_.clear();
      past_.push_back(point_);
      trial_ = point_;
      return follow_to(target);
    }
    record(point_.parameter);
    if (options_.progress && !options_.progress(point_.parameter)) {
      return interrupted();
    }
    if (report.iterations <= 4) step = std::min(2.0 * step, 5e-3 * length);
  }
  return ended(numerics::Termination::iteration_limit, "the path does not come back to the asked travel");
}

}  // namespace snare::coupling
