// Energy, momentum and what else is summed up along a motion.

#include "base/index.hpp"
#include "coupling/dynamics/contact/contact_touches.hpp"
#include "coupling/dynamics/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;
using numerics::DaePoint;

namespace {

// A start may have 1000 m/s along each axis. A steel wire that is struck breaks at some 230 m/s (theory.md
// W.35), and what a contact does at a speed near that of the wire's own waves, 5000 m/s, its law does not
// know.
constexpr double fastest_body = 2000.0;  // [m/s]

}  // namespace

EnergyBalance MotionRun::stored(const DaePoint& at, MotionSample* into) {
  EnergyBalance e;
  for (wire::RodPart& r : rods_) {
    const wire::RodPart::Energies w = r.energies(at);
    e.kinetic += w.kinetic;
    e.strain += w.strain;
    e.potential += w.potential;
    if (into == nullptr) continue;
    into->momentum += w.momentum;
    into->angular_momentum += w.angular_momentum;
    into->mount_forces.push_back(w.mount_forces[0]);
    into->mount_forces.push_back(w.mount_forces[1]);
  }
  for (const auto& i : interactions_) e.strain += i->energy(at);
  for (const BodyPart& b : bodies_) {
    if (!b.moves_freely()) continue;
    const multibody::RigidBodyState s = b.state(at.y);
    e.kinetic += multibody::kinetic_energy(b.body().properties, s);
    e.potential -= b.body().properties.mass * motion_.gravity.dot(s.position);
    if (into == nullptr) continue;
    into->momentum += b.body().properties.mass * s.velocity;
    into->angular_momentum += multibody::angular_momentum(b.body().properties, s);
  }
  constraints_->add_energy(at.y, e, into);
  if (into != nullptr) constraints_->fill(at.time, at.y, *into);
  return e;
}

void MotionRun::integrands(const DaePoint& at, Eigen::Ref<VectorXd> rates) {
  for (wire::RodPart& rod : rods_) {
    const wire::RodPart::Energies w = rod.energies(at);
    const wire::RodInMotion& c = rod.constants();
    rates[integral::dissipated] += w.dissipation;
    rates.segment<3>(integral::outer) +=
        w.mount_forces[0] + w.mount_forces[1] + c.mass_per_length * c.length * motion_.gravity - w.drag;
    rates.segment<3>(integral::outer_moment) +=
        w.mount_moments[0] + w.mount_moments[1] + w.weight_moment - w.drag_moment;
  }
  for (const BodyPart& b : bodies_) {
    if (!b.moves_freely()) continue;
    rates[integral::dissipated] += b.drag_power(at.y);
    rates[integral::work] += b.force_power(at.y);
    const Vector3d force = b.body().force + b.body().properties.mass * motion_.gravity -
                           b.body().linear_drag * at.y.segment<3>(b.velocity());
    const multibody::RigidBodyState state = b.state(at.y);
    rates.segment<3>(integral::outer) += force;
    rates.segment<3>(integral::outer_moment) +=
        state.position.cross(force) - b.body().angular_drag * (state.orientation * state.spin);
  }
  ConstraintSet::Outer held = constraints_->outer(at);
  const auto count = static_cast<Eigen::Index>(interactions_.size());
  Eigen::Index k = 0;
  for (const auto& i : interactions_) {
    i->add_rates(
        at, {rates, integral::contacts + 3 * k, integral::contacts + 3 * count + k, *constraints_, held});
    ++k;
  }
  for (const LoadPart& l : loads_) constraints_->add_load(l, at, held);
  rates.segment<3>(integral::outer) += held.force;
  rates.segment<3>(integral::outer_moment) += held.moment;
  rates[integral::work] += held.power;
  rates[integral::dissipated] += held.lost;
}

// Of a wire that a law stands for tension alone is known.
void MotionRun::watch_law_wire(std::size_t k, double tension) {
  const LawWire& wire = motion_.law_wires[k];
  const std::size_t index = rods_.size() + k;
  if (wire.tightness.watched) sums_.wires[index].add(wire.tightness, time_, tension);
  if (std::isinf(wire.strength.breaking_tension)) return;
  StrengthUse& largest = sums_.strength[index];
  const double share = tension / wire.strength.breaking_tension;
  if (share <= largest.share) return;
  largest = {share, tension, 0.0, 0.0, time_};
  if (share >= 1.0 && wire.strength.ends_run) broken_ = wire.name + strength_reached(wire.strength, largest);
}

double MotionRun::let_go() const {
  double sum = 0.0;
  for (const auto& i : interactions_) sum += i->let_go();
  return sum;
}

double MotionRun::law_loss(const DaePoint& at) const {
  double sum = 0.0;
  for (const auto& i : interactions_) sum += i->law_loss(at);
  return sum;
}

double MotionRun::longest_step() const {
  double step = std::numeric_limits<double>::infinity();
  for (const auto& i : interactions_) step = std::min(step, i->longest_step());
  for (const RobotLoop& l : loops_) step = std::min(step, l.longest_step());
  return step;
}

void MotionRun::sense_forces(double from) {
  for (RobotLoop& l : loops_) {
    l.sense_forces(from, time_, [&](double time) {
      const VectorXd y = time == time_ ? y_ : ida_->interpolate(time);
      Vector3d force = Vector3d::Zero();
      for (const MotionRobot::Measured& m : l.robot().measured)
        force += m.sign * interactions_[base::at(m.contact)]->load({time, y, rate_}).force;
      return force;
    });
  }
}

void MotionRun::book(std::size_t interaction, MotionEvent event) {
  event.contact = static_cast<int>(interaction);
  sums_.events.push_back(event);
}

void MotionRun::observe_interactions(double time_before, const VectorXd& before) {
  VectorXd forces(static_cast<Eigen::Index>(interactions_.size()));
  std::size_t law_wire = 0;
  for (std::size_t k = 0; k < interactions_.size(); ++k) {
    Interaction& interaction = *interactions_[k];
    const Interaction::Observed seen = interaction.observe({time_, y_, rate_}, time_before, before);
    forces[static_cast<Eigen::Index>(k)] = seen.normal;
    sums_.largest_penetration = std::max(sums_.largest_penetration, seen.penetration);
    for (const MotionEvent& e : seen.events) book(k, e);
    if (law_wire < law_wires_.size() && law_wires_[law_wire] == &interaction)
      watch_law_wire(law_wire++, seen.tension);
  }
  peak_.add(time_before, time_, forces, integrals_.tail(forces.size()), sums_.peak_force);
  // Laws take no mass of the wire along at once.
  for (std::size_t k = 0; k < interactions_.size(); ++k) {
    double& peak = sums_.peak_force[k];
    if (interactions_[k]->is_law()) peak = std::max(peak, forces[static_cast<Eigen::Index>(k)]);
  }
}

// Extremes over the accepted steps, and what happened since the last one.
void MotionRun::record_extremes(double time_before, const VectorXd& before) {
  sums_.strength.resize(rods_.size() + law_wires_.size());
  sums_.wires.resize(rods_.size() + law_wires_.size());
  observe_interactions(time_before, before);
  const DaePoint at{time_, y_, rate_};
  sums_.largest_drift = std::max(sums_.largest_drift, constraints_->largest_gap(y_));
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const BodyPart& b = bodies_[k];
    sums_.largest_drift = std::max(sums_.largest_drift, std::abs(y_.segment<4>(b.quaternion()).norm() - 1.0));
    const double speed = b.state(y_).velocity.norm();
    if (speed > fastest_body)
      broken_ = fmt::format("{} moves at {:.4g} m/s; bodies are computed up to {:g} m/s",
                            motion_.bodies[k].name, speed, fastest_body);
  }
  for (const wire::RodPart& r : rods_) sums_.largest_drift = std::max(sums_.largest_drift, r.mount_error(y_));
  for (std::size_t w = 0; w < rods_.size(); ++w) {
    const MotionWire& wire = motion_.wires[w];
    if (const auto broken = watch_strength(wire.strength, rods_[w], at, sums_.strength[w]))
      broken_ = wire.name + *broken;
    if (wire.tightness.watched) sums_.wires[w].add(wire.tightness, time_, tension(static_cast<int>(w)));
    if (!wire.rod.quasi_static) continue;
    const wire::RodPart::LeftOut left_out = rods_[w].left_out(y_);
    left_out_[w].add(time_, left_out.kinetic, left_out.momentum, sums_.left_out[w]);
  }
}

// Interpolated unknowns err by more than what a foundation gives: their force says nothing.
ContactSample MotionRun::recorded(std::size_t interaction, const DaePoint& at) const {
  ContactSample sample = interactions_[interaction]->sample(at);
  const std::optional<int> held = interactions_[interaction]->held_states();
  if (!held || at.time == time_ || (!sample.closed && *held < 2)) return sample;
  const auto force = [&](std::size_t i) {
    return forces_.at(at.time, static_cast<Eigen::Index>(i), std::max(2, *held));
  };
  const std::size_t first = 3 * interaction;
  return with_force(std::move(sample), {force(first), force(first + 1), force(first + 2)},
                    force(3 * interactions_.size() + interaction));
}

namespace {

WireLoads loads_of(wire::RodPart& rod, const DaePoint& at) {
  const auto [tensions, moments] = rod.section_loads(at);
  WireLoads loads{Eigen::Matrix3Xd(3, rod.vertices()), VectorXd(rod.vertices()),
                  moments / rod.model().properties().bending_stiffness};
  const Eigen::Index last = tensions.size() - 1;
  for (int i = 0; i < rod.vertices(); ++i) {
    loads.velocities.col(i) = at.y.segment<3>(rod.velocity_of(i));
    loads.tensions[i] =
        0.5 * (tensions[std::max<Eigen::Index>(i - 1, 0)] + tensions[std::min<Eigen::Index>(i, last)]);
  }
  return loads;
}

}  // namespace

MotionSample MotionRun::sample(const DaePoint& at, const VectorXd& integrals) {
  MotionSample s;
  s.time = at.time;
  EnergyBalance e = stored(at, &s);
  // The polynomials through the last steps may overshoot between them; the dissipation only grows.
  e.dissipated = std::clamp(
      integrals[integral::dissipated] + law_losses_.at(at.time) + constraints_->lost(at.y) + let_go(),
      lost_before_, lost_);
  e.work += integrals[integral::work];
  e.integrator = e.kinetic + e.strain + e.potential + e.dissipated - e.work - sums_.start_energy;
  e.corrected = corrected_;
  s.energy = e;
  for (const BodyPart& b : bodies_) s.bodies.push_back(b.state(at.y));
  for (std::size_t k = 0; k < interactions_.size(); ++k) {
    s.contacts.push_back(recorded(k, at));
    interactions_[k]->take_from_mounts(at.y, s.mount_forces);
  }
  if (options_.wire_loads) {
    for (wire::RodPart& r : rods_) s.wire_loads.push_back(loads_of(r, at));
  }
  for (const wire::RodPart& r : rods_) {
    Eigen::Matrix3Xd x(3, r.vertices());
    for (int i = 0; i < r.vertices(); ++i) x.col(i) = at.y.segment<3>(r.position_of(i));
    s.wires.push_back(std::move(x));
  }
  for (const LawWirePart* w : law_wires_) {
    LawWirePart::Shape shape = w->shape(at.y);
    s.wires.push_back(std::move(shape.points));
    for (const Vector3d& force : shape.mount_forces) s.mount_forces.push_back(force);
    s.law_tensions.push_back(shape.tension);
  }
  return s;
}

}  // namespace snare::coupling
