#include "coupling/statics/planar_push.hpp"

#include "coupling/statics/contact_forces.hpp"
#include "coupling/statics/out_of_plane.hpp"
#include "wire/end_tangents.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int history_length = 4;  // points behind the predictor: a cubic

}  // namespace

PlanarPush::PlanarPush(PushSetup setup, const PushProblem& test, const PushOptions& options)
    : PushPath(test, options, StepMeasure::attempted),
      setup_(std::move(setup)),
      system_(*setup_.system),
      torsional_stiffness_(test.wire.torsional_stiffness()) {
  point_ = setup_.start;
  if (!options.variations.empty()) sensitivity_.emplace(test, setup_.rod->mesh(), options.variations);
}

std::function<void()> PlanarPush::checkpoint() {
  const auto memories = sensitivity_ ? sensitivity_->memories() : PushSensitivity::Memories();
  return
      [this, memories, point = point_, past = past_, states = system_.contact_states(), unstable = unstable_,
       dissipated = dissipated_, differentiated_at = differentiated_at_, events = curve_.events.size()] {
        point_ = point;
        past_ = past;
        system_.restore(states);
        unstable_ = unstable;
        dissipated_ = dissipated;
        differentiated_at_ = differentiated_at;
        if (sensitivity_) sensitivity_->restore(memories);
        curve_.events.resize(events);
        assembled_at_.reset();
      };
}

// The force on the pusher, the material at the contact, and the places of the mounts that slip.
RememberingPath::Measures PlanarPush::measures() {
  const wire::PlanarRodProperties& p = system_.rod().properties();
  const auto& reaction = system_.mount_reactions();
  const double force = p.bending_stiffness / (span_ * span_) + reaction[0].norm() + reaction[1].norm();
  const auto mounts = static_cast<Eigen::Index>(system_.mounts.size());
  Measures m{Eigen::VectorXd(3 + mounts), Eigen::VectorXd(3 + mounts)};
  m.values.head<2>() = system_.pusher_force(point_);
  m.allowed.head<2>().setConstant(options_.path_tolerance * force);
  // A pusher that is apart keeps abreast of some material; which one is of no consequence.
  const bool apart = system_.sliding[0].status == ContactStatus::open;
  m.values[2] = apart ? 0.0 : point_.border[system_.pusher_rows().coordinate];
  for (Eigen::Index k = 0; k < mounts; ++k)
    m.values[3 + k] = system_.mounts[static_cast<std::size_t>(k)].last;
  m.allowed.tail(1 + mounts).setConstant(0.01 * options_.path_tolerance * span_);
  return m;
}

numerics::SolveReport PlanarPush::start() {
  curve_.natural_height = setup_.natural_height;
  curve_.touch_height = setup_.start.parameter + system_.sliding[0].centre.y();
  iterations_ = setup_.iterations;
  if (sensitivity_) sensitivity_->begin(system_, point_, workspace_);
  SlidingContact& pusher = system_.sliding[0];
  pusher.status =
      pusher.friction > 0.0 && !pusher.holds_material ? ContactStatus::stick : ContactStatus::slip;
  remember_contact(system_, point_);
  past_.push_back(point_);
  settling_ = true;
  numerics::SolveReport settled = settle_mounts();
  settling_ = false;
  return settled;
}

// The loose wire was found between mounts that hold. One that does not hold it slips at first touch, the
// pusher standing
// still: its limit falls from the force there, in steps that are halved when they fail.
numerics::SolveReport PlanarPush::settle_mounts() {
  constexpr double smallest_share = 1e-4;
  const std::vector<SlippingMount> wanted = system_.mounts;
  const auto slips = [](const SlippingMount& m) { return !m.follows && std::abs(m.last_drive) > m.limit; };
  if (std::none_of(wanted.begin(), wanted.end(), slips)) return {};
  double share = 0.0;
  double step = 1.0;
  while (share < 1.0) {
    const double next = std::min(1.0, share + step);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const double excess = slips(wanted[k]) ? std::abs(wanted[k].last_drive) - wanted[k].limit : 0.0;
      system_.mounts[k].limit = wanted[k].limit + (1.0 - next) * excess;
    }
    const StepOutcome outcome = step_to(point_.parameter);
    if (outcome.kind == StepOutcome::Kind::stopped) return outcome.report;
    if (outcome.kind != StepOutcome::Kind::failed) {
      share = next;
      continue;
    }
    step *= 0.5;
    if (step < smallest_share) {
      return ended(outcome.report.termination,
                   "the mounts do not hold the loose wire, and no shape in which they do was found");
    }
  }
  return {};
}

numerics::PathPoint PlanarPush::predict(double travel) {
  if (past_.size() < 2) {
    if (system_.sliding[0].status == ContactStatus::open) {
      numerics::PathPoint guess = point_;
      guess.parameter = travel;
      return guess;
    }
    const std::optional<numerics::PathTangent> t = numerics::tangent(system_, point_, workspace_, nullptr);
    ++iterations_;
    if (!t) return {point_.band, point_.border, travel};
    const double factor = (travel - point_.parameter) / t->parameter;
    return {point_.band + factor * t->band, point_.border + factor * t->border, travel};
  }
  // Lagrange polynomial x(t) = x_n + sum_i (x_i - x_n) prod_j (t - t_j)/(t_i - t_j), in differences to the
  // newest point: what does not change (the mounts) then stays to the last bit.
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
numerics::SolveReport PlanarPush::solve(double travel) {
  trial_ = predict(travel);
  // Else the sliders would stay behind by the material that moves in this step: an error of first order.
  if (system_.rod().has_memory()) system_.carry_sections(travel);
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
        return report.end(numerics::Termination::step_too_small, "the step leaves the path");
      }
    }
    if (system_.sliding[0].status != ContactStatus::open) pressed_ = trial_;
    if (!settle_contact(system_, trial_, memory_)) return report;
    if (system_.sliding[0].status == ContactStatus::open && pressed_.parameter == travel) return report;
  }
  return report.end(numerics::Termination::iteration_limit, "the contact does not settle");
}

StepOutcome PlanarPush::step_to(double travel) {
  const double length = travel - point_.parameter;
  const ContactStates saved = system_.contact_states();
  const numerics::PathPoint before = point_;
  const int modes_before = unstable_;
  memory_.begin();
  const numerics::SolveReport report = solve(travel);
  // Friction changes or the wire leaves inside the step: go to just where it happens first.
  const std::optional<double> at = memory_.event_fraction();
  if (at && *at < 0.99999 && *at * std::abs(length) > 10.0 * options_.smallest_step) {
    system_.restore(saved);
    return {StepOutcome::Kind::event, {}, *at};
  }
  if (pressed_.parameter == travel && system_.sliding[0].status == ContactStatus::open &&
      saved.sliding[0].status != ContactStatus::open) {
    trial_ = pressed_;
    const numerics::SolveReport left = lift_off(saved);
    return {left.usable() ? StepOutcome::Kind::elsewhere : StepOutcome::Kind::stopped, left};
  }
  if (!report.usable()) {
    system_.restore(saved);
    past_.assign(1, point_);  // the past misleads here: predict along the tangent
    return {StepOutcome::Kind::failed, report};
  }
  const bool contact_changed = memory_.changed();
  accept(saved);
  unstable_ = count_unstable_modes();
  if (unstable_ != modes_before && !contact_changed) {
    const numerics::PathPoint beyond = locate_bifurcation(before, modes_before);
    if (options_.instability == Instability::switch_branch && modes_before == 0) return switch_branch(beyond);
  }
  return {StepOutcome::Kind::taken};
}

StepOutcome PlanarPush::try_step_to(double travel) {
  trying_ = true;
  StepOutcome outcome = step_to(travel);
  trying_ = false;
  return outcome;
}

numerics::SolveReport PlanarPush::without_steps(double target, const numerics::SolveReport& last) {
  if (system_.wrapped.empty() && system_.mounts.empty()) return follow_arc(target);
  return ended(last.termination, last.message);
}

void PlanarPush::accept(const ContactStates& states_before) {
  assembled_at_ = trial_.parameter;
  const double before = point_.parameter;
  const std::vector<PushEvent::Kind> events = contact_events(states_before, system_);
  dissipated_ += friction_work(system_, states_before, point_, trial_);
  if (sensitivity_ && own_steps_ && !trying_) {
    sensitivity_->carry_sections(states_before.sections, system_, trial_.parameter);
    differentiate(trial_);
  }
  const bool same_contact = !memory_.changed() && trial_.border.size() == point_.border.size();
  const bool turned = !past_.empty() && past_.size() >= 2 &&
                      (trial_.parameter - before) * (before - past_[past_.size() - 2].parameter) < 0.0;
  if (!same_contact || turned || trial_.parameter == before) past_.clear();
  if (past_.size() >= 2 &&
      std::abs(trial_.parameter - before) < 1e-2 * std::abs(before - past_[past_.size() - 2].parameter)) {
    past_.pop_back();
  }
  point_ = trial_;
  past_.push_back(point_);
  if (past_.size() > history_length) past_.pop_front();
  remember_contact(system_, point_);
  // A gap that had closed at the end of the step before touched there.
  const bool touched_before = states_before.sliding[0].last_gap < 1e-6 * system_.length_scale();
  for (const PushEvent::Kind kind : events) {
    const bool earlier = kind == PushEvent::Kind::touch && touched_before;
    curve_.events.push_back({kind, earlier ? before : point_.parameter});
  }
}

void PlanarPush::begin_again_at(const numerics::PathPoint& point) {
  past_.clear();
  point_ = point;
  past_.push_back(point_);
  remember_contact(system_, point_);
  system_.drift.rate = {};
}

void PlanarPush::differentiate(const numerics::PathPoint& at) {
  if (settling_)
    sensitivity_->advance_at_touch(system_, at, workspace_);
  else
    sensitivity_->advance(system_, at, workspace_);
  differentiated_at_ = at.parameter;
}

// Form of the rates dq/d travel, the contact staying as it is.
double PlanarPush::viscous_stiffness() {
  if (system_.sliding[0].status == ContactStatus::open) return 0.0;
  const std::optional<numerics::PathTangent> tangent =
      numerics::tangent(system_, point_, workspace_, nullptr);
  if (!tangent) return 0.0;
  const numerics::PathTangent& along = *tangent;
  const wire::PlanarState now = system_.state(point_);
  const wire::PlanarState ahead = system_.state({along.band, along.border, 0.0});
  wire::PlanarState rate{along.band / along.parameter, {}, nullptr};
  for (const SlidingContact& contact : system_.sliding) {
    const auto k = static_cast<std::size_t>(contact.control);
    rate.controls[k] = ahead.controls[k] / along.parameter;
  }
  for (const SlippingMount& mount : system_.mounts) {
    const auto k = static_cast<std::size_t>(mount.control());
    if (mount.feeds()) rate.controls[k] = ahead.controls[k] / along.parameter;
  }
  return system_.rod().rate_form(now, rate);
}

void PlanarPush::record(double travel) {
  if (sensitivity_) {
    if (differentiated_at_ != point_.parameter || !own_steps_) differentiate(point_);
    assembled_at_.reset();
  }
  const SlidingContact& pusher = system_.sliding[0];
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
  const auto in_space = [](const std::array<Vector2d, 2>& of) {
    return std::array{Vector3d(of[0].x(), of[0].y(), 0.0), Vector3d(of[1].x(), of[1].y(), 0.0)};
  };
  const std::array<Vector2d, 2> mounts = mount_forces(system_, point_);
  const wire::PlanarRod& rod = system_.rod();
  put_end_forces(in_space(mounts), in_space(wire::end_tangents(rod, state)), rod.tensions(state), p);
  const Vector2d weight = (state.controls[2] - state.controls[0]) * rod.properties().weight;
  p.imbalance = (mounts[0] + mounts[1] + force + weight).norm();
  const PusherForces contact = pusher_forces(system_, state, point_);
  p.normal_force = contact.normal;
  p.friction_force = contact.friction;
  p.slipping = contact.slipping;
  const ContactExtent extent = contact_extent(system_, state);
  p.contact_coordinate = extent.coordinate;
  p.wrapped_length = extent.length;
  p.energy = system_.rod().energy(state);
  p.bending_moment = system_.rod().moments(state).lpNorm<Eigen::Infinity>();
  if (sensitivity_) p.force_by = sensitivity_->force_by();
  if (options_.examine_rates) p.viscous_stiffness = viscous_stiffness();
  p.dissipated = dissipated_;
  p.unstable_modes = unstable_;
  if (options_.examine_out_of_plane) {
    p.out_of_plane_modes = out_of_plane_modes(system_.rod(), state, torsional_stiffness_);
  }
  p.in_contact = pusher.status != ContactStatus::open;
  add(p);
  for (const double wanted : options_.shapes_at) {
    if (std::abs(wanted - travel) < 1e-12) keep_shape(travel);
  }
}

void PlanarPush::keep_shape(double travel) {
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

}  // namespace snare::coupling
