#include "coupling/statics/push_solver.hpp"

#include "coupling/statics/contact_switch.hpp"
#include "coupling/statics/push_setup.hpp"
#include "coupling/statics/spatial_push.hpp"
#include "wire/equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;

constexpr int history_length = 4;  // points behind the predictor: a cubic

/// Follows one push from first touch through the asked travels.
class PushFollower {
 public:
  PushFollower(PushSetup setup, const PushProblem& test, const PushOptions& options)
      : setup_(std::move(setup)), system_(*setup_.system), options_(options),
        torsional_stiffness_(test.wire.torsional_stiffness()), point_(setup_.start) {
    if (!options.variations.empty() && differentiable(test)) {
      sensitivity_.emplace(test, setup_.rod->mesh(), options.variations);
      remembers_ = test.pusher.friction > 0.0 || test.mount.slip_tension || test.wire.yielding || test.wire.strand_friction;
    }
  }

  PushCurve run(const std::vector<double>& travel);

 private:
  [[nodiscard]] bool advance(double target);
  [[nodiscard]] numerics::SolveReport step_to(double travel);
  [[nodiscard]] numerics::PathPoint predict(double travel);
  [[nodiscard]] bool follow_arc(double target);
  void examine_stability();
  [[nodiscard]] numerics::PathPoint locate_bifurcation(const numerics::PathPoint& before, int modes_before);
  [[nodiscard]] bool leave_unstable_branch();
  [[nodiscard]] bool snap_free_wire();
  void accept(const ContactStates& before);
  [[nodiscard]] bool lift_off(const ContactStates& before);
  void record(double travel);
  void differentiate(const numerics::PathPoint& at);
  [[nodiscard]] double viscous_stiffness();
  void note(PushEvent::Kind kind) { curve_.events.push_back({kind, point_.parameter}); }
  void keep_shape(double travel);
  [[nodiscard]] int count_unstable_modes();
  [[nodiscard]] bool fail(numerics::Termination termination, const std::string& message);

  PushSetup setup_;
  PushSystem& system_;
  const PushOptions& options_;
  double torsional_stiffness_;
  numerics::PathPoint point_;            // last accepted
  std::deque<numerics::PathPoint> past_; // accepted ones with the same contact, newest last
  numerics::PathWorkspace workspace_;
  std::optional<PushSensitivity> sensitivity_;
  bool remembers_ = false;               // friction or a slipping mount: derivatives go from point to point
  std::optional<double> differentiated_at_;
  ContactMemory memory_;
  PushCurve curve_;
  numerics::PathPoint trial_;
  numerics::PathPoint pressed_;          // last solution in which the pusher pressed
  std::optional<double> assembled_at_;   // parameter of the accepted point that the system was assembled at last
  int unstable_ = 0;
  int iterations_ = 0;                   // since the last record
  double dissipated_ = 0.0;
};

bool PushFollower::fail(numerics::Termination termination, const std::string& message) {
  // What stopped the push may have converged by itself and still be of no use.
  curve_.report.termination =
      termination == numerics::Termination::converged ? numerics::Termination::step_too_small : termination;
  curve_.report.message = fmt::format("{} at a travel of {:.6g} mm", message, 1e3 * point_.parameter);
  return false;
}

numerics::PathPoint PushFollower::predict(double travel) {
  if (past_.size() < 2) {
    if (system_.guided[0].status == ContactStatus::open) {
      numerics::PathPoint guess = point_;
      guess.parameter = travel;
      return guess;
    }
    const numerics::PathTangent t = numerics::tangent(system_, point_, workspace_, nullptr);
    ++iterations_;
    const double factor = (travel - point_.parameter) / t.parameter;
    if (t.band.size() == 0) return {point_.band, point_.border, travel};
    return {point_.band + factor * t.band, point_.border + factor * t.border, travel};
  }
  // Lagrange polynomial through the last points, in their differences to the newest: what does not change (the
  // mounts) then stays to the last bit.
  numerics::PathPoint guess{point_.band, point_.border, travel};
  // Over a tiny step a cubic would only amplify round-off: a straight line.
  const bool tiny = std::abs(travel - point_.parameter) < 1e-5 * system_.length_scale();
  const std::size_t first = tiny ? past_.size() - 2 : 0;
  for (std::size_t i = first; i + 1 < past_.size(); ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < past_.size(); ++j) {
      if (j != i) weight *= (travel - past_[j].parameter) / (past_[i].parameter - past_[j].parameter);
    }
    guess.band += weight * (past_[i].band - point_.band);
    guess.border += weight * (past_[i].border - point_.border);
  }
  return guess;
}

// Solves at one travel and settles the contact there. `trial_` is the result.
numerics::SolveReport PushFollower::step_to(double travel) {
  trial_ = predict(travel);
  const Eigen::VectorXd predicted = trial_.band;
  const double predicted_move = (predicted - point_.band).lpNorm<Eigen::Infinity>();
  numerics::SolveReport report;
  for (int round = 0; round < 60; ++round) {
    report = numerics::correct(system_, trial_, workspace_, options_.max_iterations);
    iterations_ += report.iterations;
    if (!report.usable()) return report;
    if (round == 0 && past_.size() >= 2) {
      const double miss = (trial_.band - predicted).lpNorm<Eigen::Infinity>();
      if (miss > 0.5 * predicted_move + 1e-6 * system_.length_scale()) {
        report.termination = numerics::Termination::step_too_small;
        report.message = "the step leaves the path";
        return report;
      }
    }
    if (system_.guided[0].status != ContactStatus::open) pressed_ = trial_;
    if (!settle_contact(system_, trial_, memory_)) return report;
    if (system_.guided[0].status == ContactStatus::open && pressed_.parameter == travel) return report;
  }
  report.termination = numerics::Termination::iteration_limit;
  report.message = "the contact does not settle";
  return report;
}

int PushFollower::count_unstable_modes() {
  if (!workspace_.factored && workspace_.solver.factorize(workspace_.system)) workspace_.factored = true;
  if (!workspace_.solver.blockwise()) return unstable_;  // at a singular point the inertia is not known
  if (system_.guided[0].status == ContactStatus::open) return workspace_.solver.negative_pivots();
  int count = workspace_.solver.negative_pivots();
  // Sliding: d2E/dS2 with the wire relaxed and the point of contact held must be positive as well.
  const SlidingContact& pusher = system_.guided[0];
  const bool slides = pusher.status == ContactStatus::slip && !pusher.holds_material && pusher.friction == 0.0;
  if (slides && system_.guided.size() == 1 && !system_.mount) {
    const Eigen::VectorXd& column = system_.rod_assembly().control_columns[1];
    const double stiffness =
        system_.rod_assembly().control_hessian(1, 1) - column.dot(workspace_.solver.solved_column(0));
    count += stiffness < 0.0 ? 1 : 0;
  }
  return count;
}

void PushFollower::accept(const ContactStates& states_before) {
  assembled_at_ = trial_.parameter;
  const double before = point_.parameter;
  const std::vector<PushEvent::Kind> events = contact_events(states_before, system_);
  dissipated_ += friction_work(system_, point_, trial_);
  if (sensitivity_ && remembers_) differentiate(trial_);
  const bool same_contact = !memory_.changed() && trial_.border.size() == point_.border.size();
  const bool turned = !past_.empty() && past_.size() >= 2 &&
                      (trial_.parameter - before) * (before - past_[past_.size() - 2].parameter) < 0.0;
  if (!same_contact || turned) past_.clear();
  if (past_.size() >= 2 && std::abs(trial_.parameter - before) <
                               1e-2 * std::abs(before - past_[past_.size() - 2].parameter)) {
    past_.pop_back();
  }
  point_ = trial_;
  past_.push_back(point_);
  if (past_.size() > history_length) past_.pop_front();
  remember_contact(system_, point_);
  // A gap that had closed at the end of the step before touched there.
  const bool touched_before = states_before.guided[0].last_gap < 1e-6 * system_.length_scale();
  for (const PushEvent::Kind kind : events) {
    const bool earlier = kind == PushEvent::Kind::touch && touched_before;
    curve_.events.push_back({kind, earlier ? before : point_.parameter});
  }
}

void PushFollower::examine_stability() {
  const int modes = count_unstable_modes();
  unstable_ = modes;
}

// The number of unstable modes changed between `before` and the accepted point while both were reached by
// ordinary steps: bisects for the travel where it does. Returns a point just beyond.
numerics::PathPoint PushFollower::locate_bifurcation(const numerics::PathPoint& before, int modes_before) {
  assembled_at_.reset();
  numerics::PathPoint low = before;
  numerics::PathPoint high = point_;
  for (int k = 0; k < 24 && std::abs(high.parameter - low.parameter) > options_.smallest_step; ++k) {
    numerics::PathPoint middle{0.5 * (low.band + high.band), 0.5 * (low.border + high.border),
                               0.5 * (low.parameter + high.parameter)};
    const numerics::SolveReport report = numerics::correct(system_, middle, workspace_, options_.max_iterations);
    iterations_ += report.iterations;
    if (!report.usable()) break;
    (count_unstable_modes() == modes_before ? low : high) = middle;
  }
  curve_.events.push_back({PushEvent::Kind::bifurcation, 0.5 * (low.parameter + high.parameter)});
  return high;
}

// At an unstable point beyond a bifurcation: pushes the wire along its softest direction until Newton's method
// ends on another equilibrium that is stable.
bool PushFollower::leave_unstable_branch() {
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
  for (double size = 1e-4; size < 0.1; size *= 2.0) {
    for (const double sign : {1.0, -1.0}) {
      trial_ = start;
      trial_.band += sign * size * system_.length_scale() * direction;
      const numerics::SolveReport report = numerics::correct(system_, trial_, workspace_, 30);
      iterations_ += report.iterations;
      if (!report.usable() || count_unstable_modes() > 0) continue;
      if ((trial_.band - start.band).lpNorm<Eigen::Infinity>() < 1e-7 * system_.length_scale()) continue;
      past_.clear();
      point_ = trial_;
      past_.push_back(point_);
      remember_contact(system_, point_);
      unstable_ = 0;
      return true;
    }
  }
  return false;
}

// The wire has left the pusher in an unstable shape: it falls into a stable one, the pusher standing still. A
// perturbation away from the pusher decides the side; a small one first.
bool PushFollower::snap_free_wire() {
  assembled_at_.reset();
  const wire::PlanarState start = system_.state(point_);
  const int last = system_.rod().mesh().edges();
  numerics::SolveReport worst;
  for (const double size : {1e-4, 1e-3, 1e-2, 5e-2}) {
    wire::PlanarState free = start;
    for (int i = 1; i < last; ++i) {
      const double bump = std::sin(std::numbers::pi * i / last);
      free.q.segment<2>(2 * i) += size * system_.length_scale() * bump * bump * system_.guided[0].motion;
    }
    const wire::EquilibriumReport report = wire::find_equilibrium(system_.rod(), free);
    iterations_ += report.iterations;
    worst = report;
    if (!report.usable()) continue;
    const ContactStates saved = system_.contact_states();
    trial_ = point_;
    trial_.band = free.q;
    if (!reseat_contact(system_, trial_, workspace_)) {
      system_.restore(saved);
      continue;
    }
    past_.clear();
    point_ = trial_;
    past_.push_back(point_);
    remember_contact(system_, point_);
    note(PushEvent::Kind::snap);
    unstable_ = 0;
    return true;
  }
  return fail(worst.termination, worst.usable() ? "after the snap no equilibrium was found on this side of the pusher"
                                                : "the wire snapped and its new shape was not found");
}

// The pusher has come to where the wire leaves it (trial_, still pressed but without force).
bool PushFollower::lift_off(const ContactStates& before) {
  system_.guided[0].status = ContactStatus::open;
  trial_.border.segment<2>(0).setZero();
  accept(before);
  assembled_at_.reset();
  // Free now: is this shape stable without the pusher?
  const numerics::SolveReport report = numerics::correct(system_, trial_, workspace_, options_.max_iterations);
  iterations_ += report.iterations;
  if (report.usable()) {
    numerics::BorderedSystem free;
    Eigen::VectorXd by_parameter;
    numerics::BandLdlt factor;
    system_.assemble(trial_, free, by_parameter);
    if (factor.factorize(free.matrix) && factor.negative_pivots() == 0) {
      unstable_ = 0;
      return true;
    }
  }
  return snap_free_wire();
}

bool PushFollower::advance(double target) {
  double step = target - point_.parameter;
  double stretch = 1.1;
  while (point_.parameter != target) {
    const double rest = target - point_.parameter;
    if (std::abs(step) > std::abs(rest) || step * rest <= 0.0) step = rest;
    // A remainder shorter than a tenth of the step is taken with it: points too near each other spoil the predictor.
    const double travel = stretch * std::abs(step) >= std::abs(rest) ? target : point_.parameter + step;
    stretch = 1.1;
    const double length = travel - point_.parameter;
    const ContactStates saved = system_.contact_states();
    const numerics::PathPoint before = point_;
    const int modes_before = unstable_;
    memory_.begin();
    const numerics::SolveReport report = step_to(travel);
    // Friction changes or the wire leaves inside the step: go to just where it happens first.
    const std::optional<double> at = memory_.event_fraction();
    if (at && *at < 0.99999 && *at * std::abs(length) > 10.0 * options_.smallest_step) {
      system_.restore(saved);
      step = *at * length;
      stretch = 1.000001;  // to just there
      continue;
    }
    if (pressed_.parameter == travel && system_.guided[0].status == ContactStatus::open &&
        saved.guided[0].status != ContactStatus::open) {
      trial_ = pressed_;
      if (!lift_off(saved)) return false;
      step = target - point_.parameter;
      continue;
    }
    if (!report.usable()) {
      system_.restore(saved);
      past_.assign(1, point_);  // the past misleads here: predict along the tangent
      step = 0.5 * length;
      if (std::abs(step) < options_.smallest_step) {
        return system_.riding.empty() && !system_.mount ? follow_arc(target)
                                                        : fail(report.termination, report.message);
      }
      continue;
    }
    const bool contact_changed = memory_.changed();
    accept(saved);
    examine_stability();
    if (unstable_ != modes_before && !contact_changed) {
      const numerics::PathPoint beyond = locate_bifurcation(before, modes_before);
      if (options_.instability == Instability::switch_branch && modes_before == 0) {
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
        if (!left) {
          return fail(numerics::Termination::step_too_small, "no stable branch was found beyond the bifurcation");
        }
        step = target - point_.parameter;
        continue;
      }
    }
    step = 2.0 * length;
  }
  return true;
}

// Natural steps have failed: a fold. Follow the path by its length until it passes the target in its own
// direction of travel, recording the points on the way.
bool PushFollower::follow_arc(double target) {
  const double sense = target > point_.parameter ? 1.0 : -1.0;
  note(PushEvent::Kind::fold);
  numerics::PathTangent direction = numerics::tangent(system_, point_, workspace_, nullptr);
  if (direction.parameter * sense < 0.0) {
    direction.band = -direction.band;
    direction.border = -direction.border;
    direction.parameter = -direction.parameter;
  }
  const double length = system_.length_scale();
  double step = 1e-4 * length;
  for (int count = 0; count < 4000; ++count) {
    const ContactStates saved = system_.contact_states();
    memory_.begin();
    numerics::SolveReport report = numerics::correct_along(system_, trial_ = point_, point_, direction, step,
                                                           workspace_, options_.max_iterations);
    iterations_ += report.iterations;
    if (!report.usable()) {
      system_.restore(saved);
      step *= 0.5;
      if (step < 1e-9 * length) return fail(report.termination, "the path cannot be followed");
      continue;
    }
    pressed_ = trial_;
    if (settle_contact(system_, trial_, memory_)) {
      const std::optional<double> at = memory_.event_fraction();
      const bool leaves = system_.guided[0].status == ContactStatus::open;
      if (!leaves || (at && *at < 0.99 && step > 1e-9 * length)) {
        system_.restore(saved);
        step *= at ? std::clamp(*at, 0.01, 0.98) : 0.5;
        if (step < 1e-9 * length) return fail(numerics::Termination::step_too_small, "the contact does not settle");
        continue;
      }
      trial_ = pressed_;
      return lift_off(saved) && advance(target);
    }
    const bool passed = (trial_.parameter - target) * sense >= 0.0;
    accept(saved);
    direction = numerics::tangent(system_, point_, workspace_, &direction);
    // The factorisation of the tangent belongs to the accepted point.
    examine_stability();
    if (passed && unstable_ == 0) {
      past_.clear();
      past_.push_back(point_);
      trial_ = point_;
      return point_.parameter == target ? true : advance(target);
    }
    record(point_.parameter);
    if (options_.progress && !options_.progress(point_.parameter)) {
      return fail(numerics::Termination::interrupted, "interrupted");
    }
    if (report.iterations <= 4) step = std::min(2.0 * step, 5e-3 * length);
  }
  return fail(numerics::Termination::iteration_limit, "the path does not come back to the asked travel");
}

void PushFollower::differentiate(const numerics::PathPoint& at) {
  sensitivity_->advance(system_, at, workspace_);
  differentiated_at_ = at.parameter;
}

// Form of the rates dq/d travel, the contact staying as it is.
double PushFollower::viscous_stiffness() {
  if (system_.guided[0].status == ContactStatus::open) return 0.0;
  numerics::PathTangent along = numerics::tangent(system_, point_, workspace_, nullptr);
  if (along.band.size() == 0) return 0.0;
  const wire::PlanarState now = system_.state(point_);
  const wire::PlanarState ahead = system_.state({along.band, along.border, 0.0});
  wire::PlanarState rate{along.band / along.parameter, {}, nullptr};
  for (const SlidingContact& contact : system_.guided) {
    const auto k = static_cast<std::size_t>(contact.control);
    rate.controls[k] = ahead.controls[k] / along.parameter;
  }
  if (system_.mount) rate.controls[0] = ahead.controls[0] / along.parameter;
  return system_.rod().rate_form(now, rate);
}

void PushFollower::record(double travel) {
  if (sensitivity_) {
    if (differentiated_at_ != point_.parameter || !remembers_) differentiate(point_);
    assembled_at_.reset();
  }
  const SlidingContact& pusher = system_.guided[0];
  PushPoint p;
  p.travel = travel;
  const Vector2d force = system_.pusher_force(point_);
  p.force = force.dot(pusher.motion);
  p.transverse_force = pusher.motion.y() * force.x() - pusher.motion.x() * force.y();
  const wire::PlanarState state = system_.state(point_);
  if (assembled_at_ != point_.parameter) {
    // A search for an event or a first point: the last assembly was elsewhere.
    system_.assemble(point_, workspace_.system, workspace_.by_parameter);
  }
  const MountForces mounts = mount_forces(system_, state, point_);
  p.tension_left = mounts.tension_left;
  p.tension_right = mounts.tension_right;
  p.imbalance = (mounts.total + force).norm();
  const PusherForces contact = pusher_forces(system_, state, point_);
  p.normal_force = contact.normal;
  p.friction_force = contact.friction;
  p.slipping = contact.slipping;
  const ContactExtent extent = contact_extent(system_, state);
  p.contact_coordinate = extent.coordinate;
  p.wrapped_length = extent.length;
  p.energy = system_.rod().energy(state);
  if (sensitivity_) p.force_by = sensitivity_->force_by();
  if (options_.examine_rates) p.viscous_stiffness = viscous_stiffness();
  p.dissipated = dissipated_;
  p.unstable_modes = unstable_;
  if (options_.examine_out_of_plane) {
    p.out_of_plane_modes = out_of_plane_modes(system_.rod(), state, torsional_stiffness_);
  }
  p.in_contact = pusher.status != ContactStatus::open;
  p.iterations = iterations_;
  curve_.newton_iterations += iterations_;
  iterations_ = 0;
  curve_.points.push_back(p);
  for (const double wanted : options_.shapes_at) {
    if (std::abs(wanted - travel) < 1e-12) keep_shape(travel);
  }
}

void PushFollower::keep_shape(double travel) {
  const wire::PlanarState state = system_.state(point_);
  const Eigen::VectorXd tension = system_.rod().tensions(state);
  const Eigen::VectorXd moment = system_.rod().moments(state);
  const int last = system_.rod().mesh().edges();
  PushShape shape;
  shape.travel = travel;
  shape.pusher_centre = system_.pusher_centre(point_);
  for (int i = 0; i <= last; ++i) {
    const Vector2d x = wire::vertex(state, i);
    shape.x.push_back(x.x());
    shape.y.push_back(x.y());
    shape.arc.push_back(system_.rod().mesh().coordinate(i, state.controls));
    shape.tension.push_back(0.5 * (tension[std::max(0, i - 1)] + tension[std::min(last - 1, i)]));
    shape.moment.push_back(moment[i]);
  }
  curve_.shapes.push_back(std::move(shape));
}

PushCurve PushFollower::run(const std::vector<double>& travel) {
  curve_.natural_height = setup_.natural_height;
  curve_.touch_height = setup_.start.parameter + system_.guided[0].centre.y();
  iterations_ = setup_.iterations;
  SlidingContact& pusher = system_.guided[0];
  if (sensitivity_) sensitivity_->begin(system_, point_, workspace_);
  pusher.status = pusher.friction > 0.0 && !pusher.holds_material ? ContactStatus::stick : ContactStatus::slip;
  remember_contact(system_, point_);
  past_.push_back(point_);
  note(PushEvent::Kind::first_touch);
  for (const double target : travel) {
    if (target != point_.parameter && !advance(target)) break;
    record(target);
    if (options_.progress && !options_.progress(target)) {
      (void)fail(numerics::Termination::interrupted, "interrupted");
      break;
    }
  }
  curve_.report.iterations = curve_.newton_iterations;
  return std::move(curve_);
}

}  // namespace

bool differentiable(const PushProblem& test) {
  return !needs_space(test);
}

std::string to_string(PushEvent::Kind kind) {
  switch (kind) {
    case PushEvent::Kind::first_touch: return "first touch";
    case PushEvent::Kind::lift_off: return "lift-off";
    case PushEvent::Kind::touch: return "touch";
    case PushEvent::Kind::slip_begins: return "slip begins";
    case PushEvent::Kind::slip_ends: return "slip ends";
    case PushEvent::Kind::wrap_begins: return "wrap begins";
    case PushEvent::Kind::wrap_ends: return "wrap ends";
    case PushEvent::Kind::mount_slips: return "mount slips";
    case PushEvent::Kind::mount_holds: return "mount holds";
    case PushEvent::Kind::fold: return "fold";
    case PushEvent::Kind::bifurcation: return "bifurcation";
    case PushEvent::Kind::snap: return "snap";
  }
  return "unknown";
}

PushCurve solve_push(const PushProblem& test, const PushOptions& options, int coarsening) {
  if (needs_space(test)) return solve_spatial_push(test, options, coarsening);
  PushSetup setup = prepare_push(test, options.elements, options.grading, coarsening);
  if (!setup.report.usable()) {
    PushCurve curve;
    curve.report = setup.report;
    return curve;
  }
  return PushFollower(std::move(setup), test, options).run(test.travel);
}

}  // namespace snare::coupling
