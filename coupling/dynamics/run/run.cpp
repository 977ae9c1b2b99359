#include "coupling/dynamics/run/run.hpp"

#include "base/errors.hpp"
#include "base/index.hpp"
#include "coupling/dynamics/contact/body_contact_part.hpp"
#include "coupling/dynamics/contact/contact_group.hpp"
#include "coupling/dynamics/contact/wire_pair_part.hpp"
#include "coupling/dynamics/laws/law_part.hpp"
#include "coupling/dynamics/run/symmetry_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;
using numerics::DaePoint;

namespace {

// Of the tolerances, that Newton's method may leave at a step.                               theory.md (M.12)
constexpr double share_of_rods = 2e-4;
constexpr double share_of_bodies = 1e-3;  // and of wires without waves
// Without waves Newton's method forgives a matrix of another step: fewer matrices, hardly more iterations.
constexpr double matrix_change_without_waves = 0.5;
// The load of what touches a wire changes too much for one matrix.
constexpr int renewals_of_wires = 4;

}  // namespace

MotionRun::MotionRun(const Motion& motion, const MotionOptions& options, const MotionObserver& observer)
    : motion_(motion),
      options_(options),
      observer_(observer),
      phases_(motion.phases),
      sensed_(motion, options.output_interval),
      progress_(options.least_advance) {
  for (const MotionWire& w : motion.wires) {
    wire::RodInMotion rod = w.rod;
    rod.properties.weight = rod.mass_per_length * motion.gravity;
    const double of_velocity =
        rod.quasi_static ? options.quasi_static_velocity_tolerance : options.velocity_tolerance;
    rods_.emplace_back(w.name, rod,
                       wire::RodTolerances{options.position_tolerance, of_velocity, options.twist_tolerance});
  }
  for (const MotionBody& b : motion.bodies)
    bodies_.emplace_back(b.robot ? loops_.emplace_back(b).moved() : b, motion.gravity, options);
  constraints_.emplace(motion, rods_, bodies_, options);
  add_interactions();
  for (const FrameLoad& l : motion.loads)
    loads_.emplace_back(l, constraints_->frame_of(l.carrier, bodies_, l.X_WF));
  system_ = std::make_unique<numerics::DaeSystem>(parts());
  if (system_->size() == 0)
    throw base::InputError({"", 0, "", "", "nothing can move: no wire with mass, no body, no arm"});
  y_ = VectorXd::Zero(system_->size());
  rate_ = y_;
  for (std::size_t i = 0; i < rods_.size(); ++i)
    rods_[i].place(motion.wires[i].positions, motion.wires[i].velocities, y_);
  for (const BodyPart& b : bodies_) b.place(y_);
  constraints_->place(y_);
  require_apart();
  stay_in_plane();
  numerics::IdaOptions ida;
  ida.relative_tolerance = options.relative_tolerance;
  ida.max_order = options.max_order.value_or(default_order());
  ida.max_step = options.max_step;
  ida.newton_test = numerics::NewtonTest::every_unknown;
  const bool waves =
      !std::ranges::all_of(motion.wires, [](const MotionWire& w) { return w.rod.quasi_static; });
  ida.newton_share = options.newton_share.value_or(waves ? share_of_rods : share_of_bodies);
  if (!waves) ida.matrix_change = matrix_change_without_waves;
  if (!rods_.empty()) ida.renewals = renewals_of_wires;
  integrals_ = VectorXd::Zero(integral::contacts + 4 * static_cast<Eigen::Index>(interactions_.size()));
  ida_ = std::make_unique<numerics::Ida>(
      *system_, ida,
      numerics::IdaIntegrals{
          static_cast<int>(integrals_.size()),
          [this](const DaePoint& at, Eigen::Ref<VectorXd> rates) { integrands(at, rates); }});
  peak_ = PeakForce(options.peak_window);
  sums_.peak_force.assign(interactions_.size(), 0.0);
  left_out_.assign(rods_.size(), LeftOutMomentum(options.peak_window));
  sums_.left_out.assign(rods_.size(), {});
}

void MotionRun::add_interactions() {
  const auto frame = [this](const MotionCarrier& carrier, const multibody::Pose& X_WF) {
    return constraints_->frame_of(carrier, bodies_, X_WF);
  };
  const auto place = [](const Vector3d& p) { return multibody::Pose{Eigen::Matrix3d::Identity(), p}; };
  const auto add = [this](auto interaction) { interactions_.push_back(std::move(interaction)); };
  for (const MotionContact& c : motion_.contacts)
    add(std::make_unique<ContactGroup>(c, rods_[base::at(c.wire)], bodies_[base::at(c.body)]));
  for (const PointContactLaw& s : motion_.point_contacts)
    add(std::make_unique<LawPart>(s, bodies_[base::at(s.body)]));
  for (const WirePair& p : motion_.wire_pairs)
    add(std::make_unique<WirePairPart>(p, rods_[base::at(p.wires[0])], rods_[base::at(p.wires[1])]));
  for (const LawWire& w : motion_.law_wires) {
    auto part = std::make_unique<LawWirePart>(w, frame(w.from, place(w.p_from)), frame(w.to, place(w.p_to)),
                                              frame(w.shaft.carrier, w.shaft.X_WS));
    law_wires_.push_back(part.get());
    add(std::move(part));
  }
  for (const BodyContact& b : motion_.body_contacts)
    add(std::make_unique<BodyContactPart>(b, frame(b.carrier, b.X_WS), frame(b.other, b.X_WP)));
}

std::vector<numerics::DaePart*> MotionRun::parts() {
  std::vector<numerics::DaePart*> list;
  for (auto& r : rods_) list.push_back(&r);
  for (auto& b : bodies_) list.push_back(&b);
  for (auto& i : interactions_) i->append(list);
  for (auto& l : loads_) list.push_back(&l);
  constraints_->append(list);
  return list;
}

int MotionRun::default_order() const {
  constexpr int a_stable = 2, of_laws = 3, of_bodies = 5;
  if (!rods_.empty()) return a_stable;
  if (std::ranges::any_of(interactions_, [](const auto& i) { return i->has_body_bristles(); }))
    return a_stable;
  return interactions_.empty() ? of_bodies : of_laws;
}

// A wire that is inside a shape has no side to which it belongs. Balls of bodies may rest on a shape, but
// what is pressed into it is thrown out.
void MotionRun::require_apart() {
  std::vector<base::InputProblem> problems;
  for (const auto& i : interactions_) {
    if (auto problem = i->overlap(y_, options_.position_tolerance)) problems.push_back(std::move(*problem));
  }
  if (!problems.empty()) throw base::InputError(problems);
}

// What would leave the plane of a motion that is its own mirror image stays as it is.        theory.md (M.36)
void MotionRun::stay_in_plane() {
  const std::optional<int> normal = symmetry_normal(motion_);
  if (!normal) return;
  std::vector<wire::RodPlane> planes;
  for (const wire::RodPart& r : rods_) {
    const std::optional<wire::RodPlane> plane = r.plane_across(*normal);
    if (!plane) return;
    planes.push_back(*plane);
  }
  std::vector<int> held;
  const auto hold = [&held](const std::vector<int>& across) {
    held.insert(held.end(), across.begin(), across.end());
  };
  for (std::size_t i = 0; i < rods_.size(); ++i) hold(rods_[i].restrict_to_plane(planes[i]));
  for (const BodyPart& b : bodies_) hold(b.unknowns_across(*normal));
  for (const auto& i : interactions_) hold(i->restrict_to_plane(*normal));
  system_->hold(std::move(held));
}

void MotionRun::leave_plane() {
  for (wire::RodPart& r : rods_) r.leave_plane();
  for (const auto& i : interactions_) i->leave_plane();
  system_->hold({});
}

namespace {

bool all_finite(const std::vector<Vector3d>& vectors) {
  return std::ranges::all_of(vectors, [](const Vector3d& v) { return v.allFinite(); });
}

/// Of what becomes columns of a history.
bool all_finite(const MotionSample& s) {
  const auto of_body = [](const multibody::RigidBodyState& b) {
    return b.position.allFinite() && b.orientation.coeffs().allFinite() && b.velocity.allFinite() &&
           b.spin.allFinite();
  };
  const auto of_contact = [](const ContactSample& c) {
    return std::isfinite(c.gap) && c.force.allFinite() && std::isfinite(c.normal_force) &&
           c.point.allFinite() && std::isfinite(c.arc) && std::isfinite(c.slip_speed);
  };
  const auto of_arm = [](const MotionSample::Arm& a) {
    return a.state.q.allFinite() && a.state.v.allFinite() && a.state.motor.allFinite() &&
           a.state.motor_rate.allFinite() && a.joint_torque.allFinite() && a.drive_torque.allFinite();
  };
  const auto of_wrench = [](const multibody::Wrench& w) {
    return w.moment.allFinite() && w.force.allFinite();
  };
  const auto of_bushing = [&](const MotionSample::Bushing& b) {
    return b.shift.allFinite() && b.turn.allFinite() && of_wrench(b.on_second);
  };
  const auto of_loads = [](const WireLoads& l) {
    return l.velocities.allFinite() && l.tensions.allFinite() && l.curvatures.allFinite();
  };
  const EnergyBalance& e = s.energy;
  return std::isfinite(e.kinetic + e.strain + e.potential + e.dissipated + e.work + e.integrator) &&
         s.momentum.allFinite() && s.angular_momentum.allFinite() && std::ranges::all_of(s.bodies, of_body) &&
         std::ranges::all_of(s.contacts, of_contact) &&
         std::ranges::all_of(s.wires, [](const Eigen::Matrix3Xd& x) { return x.allFinite(); }) &&
         std::ranges::all_of(s.wire_loads, of_loads) && all_finite(s.mount_forces) &&
         std::ranges::all_of(s.law_tensions, [](double t) { return std::isfinite(t); }) &&
         std::ranges::all_of(s.arms, of_arm) && std::ranges::all_of(s.welds, of_wrench) &&
         std::ranges::all_of(s.bushings, of_bushing);
}

}  // namespace

bool MotionRun::emit(const MotionSample& sample) {
  if (all_finite(sample)) return observer_(sample);
  if (sample.time == 0.0) {
    throw base::InputError(
        {"", 0, "start", "",
         "must have finite forces and accelerations: a mass is too small, or a force, a stiffness, a "
         "speed or a length too large to be computed with"});
  }
  not_finite_ = true;
  return true;
}

bool MotionRun::write_until(double time) {
  if (!observer_) return false;
  while (static_cast<double>(sums_.samples) * options_.output_interval <= time) {
    const double t = static_cast<double>(sums_.samples) * options_.output_interval;
    ++sums_.samples;
    if (t == time_) {
      if (emit(sample({t, y_, rate_}, integrals_))) return true;
      continue;
    }
    const VectorXd y = ida_->interpolate(t);
    const VectorXd rate = ida_->interpolate(t, 1);
    const MotionSample between = sample({t, y, rate}, ida_->interpolate_integrals(t));
    lost_before_ = between.energy.dissipated;
    if (emit(between)) return true;
  }
  return false;
}

// No rate of a loss is negative; above second order the integrator's sum of them may yet fall, within its
// tolerance.
void MotionRun::count_losses() {
  const double others = integrals_[integral::laws] + constraints_->lost(y_) + let_go();
  const double sum = integrals_[integral::dissipated] + others;
  corrected_ += std::max(0.0, lost_ - sum);
  lost_ = std::max(sum, lost_);  // not a number, if that is not
  integrals_[integral::dissipated] = lost_ - others;
}

void MotionRun::begin() {
  for (const auto& i : interactions_) i->update_candidates(y_);
  MotionSample start;
  const EnergyBalance energy = stored({0.0, y_, rate_}, &start);
  sums_.start_energy = energy.kinetic + energy.strain + energy.potential;
  sums_.start_momentum = start.momentum;
  sums_.start_angular_momentum = start.angular_momentum;
  constraints_->place_twist_rates(y_, rate_);
  restart();
  sense();
  phases_.start(0.0, signals(), kept());
}

void MotionRun::resume(const MotionState& from) {
  if (from.unknowns.size() != y_.size() || from.rates.size() != y_.size() ||
      from.integrals.size() != integrals_.size() || from.sums.left_out.size() != sums_.left_out.size() ||
      from.sums.peak_force.size() != sums_.peak_force.size()) {
    throw base::InputError({"", 0, "state", fmt::format("{} unknowns", from.unknowns.size()),
                            fmt::format("must be that of the same motion, of {} unknowns", y_.size())});
  }
  time_ = from.time;
  y_ = from.unknowns;
  rate_ = from.rates;
  integrals_ = from.integrals;
  sums_ = from.sums;
  std::span<const double> memory = from.memory;
  for (const auto& i : interactions_) i->restore_touches(memory);
  peak_.restore_state(memory);
  for (LeftOutMomentum& p : left_out_) p.restore_state(memory);
  lost_ = lost_before_ = numerics::take(memory);
  corrected_ = numerics::take(memory);
  restore_phases(memory);
  for (RobotLoop& l : loops_) l.restore_state(memory);
  constraints_->restore_state(time_, memory);
  for (LoadPart& l : loads_) static_cast<void>(l.begin_interval(time_));
  system_->restore_state(y_, memory);
  law_losses_ = LossSum(integrals_[integral::laws]);
  law_losses_.begin(time_, law_loss({time_, y_, rate_}));
  ida_->set_integrals(integrals_);
  ida_->start(time_, y_, rate_);
}

// Two times at which something changes that differ by round-off: 0.1 + 0.2 beside 0.3. The integrator cannot
// step from one to the other.
void MotionRun::cross_break(double time) {
  time_ = time;
  static_cast<void>(constraints_->process_events({time_, y_, rate_}, {}, y_));
  for (LoadPart& l : loads_) static_cast<void>(l.begin_interval(time_));
  if (look_for_phase())
    over_ = begin_phases();
  else
    restart();
}

double MotionRun::next_break(double limit) const {
  double stop = std::min({limit, constraints_->limit(), phases_.limit(time_)});
  for (const LoadPart& l : loads_) stop = std::min(stop, l.next_break(time_));
  for (const RobotLoop& l : loops_) stop = std::min(stop, l.next_break(time_));
  if (phases_.asks_for_readings()) stop = std::min(stop, sensed_.limit(time_));
  return stop;
}

MotionRun::Crossed MotionRun::cross_events(double time_before, std::span<const int> found) {
  Crossed crossed;
  const DaePoint now{time_, y_, rate_};
  std::vector<int> sense(interactions_.size(), 0);  // of each event: 1 it begins to press, -1 it ends
  std::size_t event = 0;
  for (std::size_t k = 0; k < interactions_.size(); ++k) {
    const Interaction& interaction = *interactions_[k];
    if (interaction.has_event()) sense[k] = found[event++];
    if (sense[k] == 0) continue;
    crossed.any = true;
    crossed.jump = crossed.jump || interaction.jumps();
    const auto kind = sense[k] > 0 ? MotionEvent::Kind::touch : MotionEvent::Kind::lift_off;
    book(k, {.time = time_, .arc = interaction.sample(now).arc, .kind = kind});
  }
  for (std::size_t k = 0; k < interactions_.size(); ++k) {
    for (const MotionEvent& e : interactions_[k]->changes(now, time_before, sense[k] != 0)) book(k, e);
  }
  return crossed;
}

void MotionRun::end(numerics::IdaReport& report, bool stopped) const {
  if (broken_) {
    report.termination = numerics::Termination::iteration_limit;
    report.message = *broken_;
  }
  if (not_finite_) {
    report.termination = numerics::Termination::not_finite;
    report.message = fmt::format("a result is not finite at {:.9g} s", time_);
  } else if (stopped && report.usable()) {
    report.termination = numerics::Termination::interrupted;
    report.message = fmt::format("stopped on request at {:.9g} s", time_);
  }
}

MotionResult MotionRun::run_until(double limit) {
  const auto clock = std::chrono::steady_clock::now();
  numerics::IdaReport report;
  VectorXd rates = VectorXd::Zero(integrals_.size());
  integrands({time_, y_, rate_}, rates);
  const auto of_contacts = integrals_.size() - integral::contacts;
  forces_.add(time_, rates.tail(of_contacts));
  sense_forces(time_);
  bool stopped = write_until(time_);
  while (!stopped && !broken_ && !over_ && !reached(time_, limit)) {
    const double stop = next_break(limit);
    if (reached(time_, stop)) {
      cross_break(stop);
      continue;
    }
    const long evaluated = ida_->statistics().residuals;
    const numerics::IdaAdvance advance = ida_->advance(stop, longest_step());
    report = ida_->report();
    if (advance == numerics::IdaAdvance::failed) break;
    const double before = std::exchange(time_, ida_->time());
    std::swap(before_, y_);
    y_ = ida_->y();
    rate_ = ida_->rate();
    integrals_ = ida_->integrals();
    const bool phase = look_for_phase();
    const VectorXd integrands = phase ? ida_->interpolate_integrals(time_, 1) : ida_->integral_rates();
    forces_.add(time_, integrands.tail(of_contacts));
    const bool cut = phase || advance == numerics::IdaAdvance::event;
    law_losses_.add(time_, cut ? law_loss({time_, y_, rate_}) : integrands[integral::laws], [this](double t) {
      return law_loss({t, ida_->interpolate(t), rate_});
    });
    integrals_[integral::laws] = law_losses_.sum();
    lost_before_ = lost_;
    count_losses();
    sense_forces(before);
    record_extremes(before, before_);
    stopped = write_until(time_) || (options_.stop && options_.stop());
    const long evaluations = ida_->statistics().residuals - evaluated;
    if (const auto stalled = progress_.add(*ida_, evaluations, options_.duration, sums_.effort)) {
      report.termination = numerics::Termination::stalled;
      report.message = *stalled;
      break;
    }
    const std::vector<int> found = ida_->events_found();
    // Events behind the beginning of a phase are events no more.
    const bool behind = time_ < ida_->time();
    bool changed = false;
    if (!behind) {
      const auto arms = static_cast<std::size_t>(constraints_->event_count());  // the last of the events
      changed = constraints_->process_events({time_, ida_->y(), rate_}, std::span(found).last(arms), y_);
    }
    if (constraints_->stuck()) {
      report.termination = numerics::Termination::step_too_small;
      report.message = *constraints_->stuck();
      break;
    }
    const Crossed crossed = behind ? Crossed{} : cross_events(before, found);
    changed = changed || crossed.jump;
    for (LoadPart& l : loads_) changed = l.begin_interval(time_) || changed;
    for (RobotLoop& l : loops_) changed = l.begin_interval(time_, changed || phase || crossed.any) || changed;
    if (phase) {
      over_ = begin_phases();
    } else if (changed) {
      restart();
    }
  }
  end(report, stopped);
  report.time = time_;
  sums_.statistics += ida_->statistics();
  sums_.wall_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return result(std::move(report));
}

MotionResult MotionRun::result(numerics::IdaReport report) {
  MotionResult r;
  r.report = std::move(report);
  const MotionSample last = sample({time_, y_, rate_}, integrals_);
  r.energy = last.energy;
  r.momentum_error = last.momentum - sums_.start_momentum - integrals_.segment<3>(integral::outer);
  r.angular_momentum_error =
      last.angular_momentum - sums_.start_angular_momentum - integrals_.segment<3>(integral::outer_moment);
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(sums_.peak_force.size()); ++k)
    r.impulse.emplace_back(integrals_.segment<3>(integral::contacts + 3 * k));
  r.events = sums_.events;
  r.peak_force = sums_.peak_force;
  r.strength = sums_.strength;
  r.wires = sums_.wires;
  r.phases = sums_.phases;
  r.left_out = sums_.left_out;
  r.largest_penetration = sums_.largest_penetration;
  r.largest_drift = sums_.largest_drift;
  r.statistics = sums_.statistics;
  r.wall_seconds = sums_.wall_seconds;
  std::vector<double> memory;
  for (const auto& i : interactions_) i->save_touches(memory);
  peak_.save_state(memory);
  for (const LeftOutMomentum& p : left_out_) p.save_state(memory);
  memory.insert(memory.end(), {lost_, corrected_});
  phases_.save_state(memory);
  sensed_.save_state(memory);
  for (const RobotLoop& l : loops_) l.save_state(memory);
  constraints_->save_state(memory);
  const std::vector<double> parts = system_->memory();
  memory.insert(memory.end(), parts.begin(), parts.end());
  r.last = {time_, y_, rate_, integrals_, std::move(memory), sums_};
  return r;
}

}  // namespace snare::coupling
