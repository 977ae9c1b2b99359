// Energy, momentum and what else is summed up along a motion.

#include "base/index.hpp"
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

// A start may have 1000 m/s along each axis. A steel wire that is struck breaks at some 230 m/s (theory.md W.35), and what a contact
// does at a speed near that of the wire's own waves, 5000 m/s, its law does not know.
constexpr double fastest_body = 2000.0;  // [m/s]

// What contact presses on rigidly held components of a wire's ends is no part of the rod's own reaction.
void add_held(const wire::RodPart& rod, const std::array<Vector3d, 2>& on_mounts, const DaePoint& at,
              Eigen::Ref<VectorXd> rates) {
  const std::array<int, 2> ends{rod.position_of(0), rod.position_of(rod.vertices() - 1)};
  for (std::size_t k = 0; k < 2; ++k) {
    rates.segment<3>(integral::outer) -= on_mounts[k];
    rates.segment<3>(integral::outer_moment) -= Vector3d(at.y.segment<3>(ends[k])).cross(on_mounts[k]);
  }
}

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
  for (const ContactGroup& c : contacts_) e.strain += c.sums(at.y).energy;
  for (const LawPart& s : point_contacts_) e.strain += s.power(at).energy;
  for (WirePairPart& p : pairs_) e.strain += p.sums(at.y).energy;
  for (const BodyPart& b : bodies_) {
    if (!b.moves_freely()) continue;
    const multibody::RigidBodyState s = b.state(at.y);
    e.kinetic += multibody::kinetic_energy(b.body().properties, s);
    e.potential -= b.body().properties.mass * motion_.gravity.dot(s.position);
    if (into == nullptr) continue;
    into->momentum += b.body().properties.mass * s.velocity;
    into->angular_momentum += multibody::angular_momentum(b.body().properties, s);
  }
  for (const UnilateralForcePart* p : unilateral_forces_) e.strain += p->work(at.y).power.energy;
  constraints_->add_energy(at.y, e, into);
  if (into != nullptr) constraints_->fill(at.time, at.y, *into);
  return e;
}

// Of a contact's force on its wire: what goes on to rigidly held components, and what a driven body gives, with its work.
void MotionRun::add_reactions(std::size_t contact, const ContactPart::Sums& sums, const DaePoint& at,
                              Eigen::Ref<VectorXd> rates) const {
  const BodyPart& body = bodies_[base::at(motion_.contacts[contact].body)];
  add_held(rods_[base::at(motion_.contacts[contact].wire)], sums.on_mounts, at, rates);
  if (body.moves_freely()) return;
  rates[integral::work] += sums.body_power;
  rates.segment<3>(integral::outer) += sums.force;
  rates.segment<3>(integral::outer_moment) += sums.moment;
}

// Both wires are counted: what their contact does to momentum is what it presses on rigidly held components, and what it does not
// twist them.
void MotionRun::add_pair(std::size_t pair, const DaePoint& at, Eigen::Ref<VectorXd> rates) {
  const WirePairPart::Sums s = pairs_[pair].sums(at.y);
  const auto index = static_cast<Eigen::Index>(contacts_.size() + point_contacts_.size() + pair);
  rates.segment<3>(integral::contacts + 3 * index) = s.force;
  rates[integral::contacts + 3 * static_cast<Eigen::Index>(touching()) + index] = s.normal;
  rates[integral::dissipated] += s.lost_power;
  rates.segment<3>(integral::outer_moment) -= s.held_moment;
  for (std::size_t w = 0; w < 2; ++w)
    add_held(rods_[base::at(motion_.wire_pairs[pair].wires[w])], s.on_mounts[w], at, rates);
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
  const auto count = static_cast<Eigen::Index>(touching());
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const ContactPart::Sums s = contacts_[k].sums(at.y);
    rates.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(k)) += s.force;
    rates[integral::contacts + 3 * count + static_cast<Eigen::Index>(k)] = s.normal;
    rates[integral::dissipated] += s.lost_power;
    add_reactions(k, s, at, rates);
  }
  for (std::size_t k = 0; k < point_contacts_.size(); ++k) {
    const ContactSample s = point_contacts_[k].sample(at);
    rates.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(contacts_.size() + k)) = s.force;
    rates[integral::contacts + 3 * count + static_cast<Eigen::Index>(contacts_.size() + k)] = s.normal_force;
    rates[integral::laws] += point_contacts_[k].power(at).lost;
    rates[integral::work] -= s.normal_force * motion_.point_contacts[k].origin_speed;
    rates.segment<3>(integral::outer) -= s.force;
    rates.segment<3>(integral::outer_moment) -= s.point.cross(s.force);
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) add_pair(k, at, rates);
  ConstraintSet::Outer held = constraints_->outer(at);
  for (std::size_t k = 0; k < unilateral_forces_.size(); ++k) {
    const auto [s, work, tension] = unilateral_forces_[k]->pressing(at.y);
    const auto index = static_cast<Eigen::Index>(first_unilateral_force() + k);
    rates.segment<3>(integral::contacts + 3 * index) = s.force;
    rates[integral::contacts + 3 * count + index] = s.normal_force;
    rates[integral::laws] += work.power.lost;
    constraints_->add_forces(*unilateral_forces_[k], work.wrenches, at, held);
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

double MotionRun::law_loss(const DaePoint& at) const {
  double sum = 0.0;
  for (const LawPart& s : point_contacts_) sum += s.power(at).lost;
  for (const UnilateralForcePart* p : unilateral_forces_) sum += p->work(at.y).power.lost;
  return sum;
}

// The integrator has no event where bodies touch from the start on.
void MotionRun::watch_body_contacts(double time_before, std::span<const int> found) {
  for (std::size_t k = 0; k < body_contacts_.size(); ++k) {
    const auto contact = static_cast<int>(first_unilateral_force() + law_wires_.size() + k);
    const auto [sample, work, tension] = body_contacts_[k].pressing(y_);
    const bool closed = !work.wrenches.empty();
    const Seen before = std::exchange(seen_[k], {closed, sample.sticking});
    const auto note = [&](double time, MotionEvent::Kind kind, double speed) {
      sums_.events.push_back({time, contact, 0, 0.0, kind, speed});
    };
    if (closed && !before.closed && found[k] == 0) note(time_before, MotionEvent::Kind::touch, 0.0);
    if (!body_contacts_[k].has_bristle() || !closed || !before.closed) continue;
    if (sample.sticking != before.sticking)
      note(time_, sample.sticking ? MotionEvent::Kind::stick : MotionEvent::Kind::slip, sample.slip_speed);
  }
}

double MotionRun::longest_step() const {
  double step = std::numeric_limits<double>::infinity();
  for (const ContactGroup& c : contacts_) step = std::min(step, c.longest_step());
  for (const WirePairPart& p : pairs_) step = std::min(step, p.search().longest_step());
  for (const RobotLoop& l : loops_) step = std::min(step, l.longest_step());
  return step;
}

void MotionRun::sense_forces(double from) {
  for (RobotLoop& l : loops_) {
    l.sense_forces(from, time_, [&](double time) {
      const VectorXd y = time == time_ ? y_ : ida_->interpolate(time);
      Vector3d force = Vector3d::Zero();
      for (const MotionRobot::Measured& m : l.robot().measured) {
        const std::size_t k = base::at(m.contact);
        force += m.sign * (k >= first_unilateral_force() ? unilateral_forces_[k - first_unilateral_force()]->pressing(y).sample.force
                                              : contacts_[k].sums(y).force);
      }
      return force;
    });
  }
}

// Extremes over the accepted steps, and what happened since the last one.
void MotionRun::record_extremes(double time_before, const VectorXd& before) {
  const auto count = static_cast<Eigen::Index>(touching());
  VectorXd forces(count);
  const auto note = [&](std::size_t contact, const ContactSample& sum, std::vector<MotionEvent> events, bool by_law) {
    for (MotionEvent& e : events) {
      e.contact = static_cast<int>(contact);
      sums_.events.push_back(e);
    }
    forces[static_cast<Eigen::Index>(contact)] = sum.normal_force;
    if (by_law) return;
    for (const ContactSample& s : sum.points) sums_.largest_penetration = std::max(sums_.largest_penetration, -s.gap);
  };
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const ContactSample sum = contacts_[k].closed_sample(y_);
    note(k, sum, contacts_[k].observe(time_, sum, y_, time_before, before), static_cast<bool>(motion_.contacts[k].law));
  }
  const DaePoint at{time_, y_, rate_};
  for (std::size_t k = 0; k < point_contacts_.size(); ++k)
    forces[static_cast<Eigen::Index>(contacts_.size() + k)] = point_contacts_[k].sample(at).normal_force;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const ContactSample sum = pairs_[k].closed_sample(y_);
    note(contacts_.size() + point_contacts_.size() + k, sum, pairs_[k].observe(sum, {time_, y_}, {time_before, before}),
         false);
  }
  sums_.strength.resize(rods_.size() + law_wires_.size());
  sums_.wires.resize(rods_.size() + law_wires_.size());
  for (std::size_t k = 0; k < unilateral_forces_.size(); ++k) {
    const UnilateralForcePart::Pressing now = unilateral_forces_[k]->pressing(y_);
    forces[static_cast<Eigen::Index>(first_unilateral_force() + k)] = now.sample.normal_force;
    if (k < law_wires_.size()) watch_law_wire(k, now.tension);
  }
  peak_.add(time_before, time_, forces, integrals_.tail(count), sums_.peak_force);
  // Laws take no mass of the wire along at once.
  for (std::size_t k = 0; k < touching(); ++k) {
    if (k < contacts_.size() && !motion_.contacts[k].law) continue;
    if (k >= contacts_.size() + point_contacts_.size() && k < first_unilateral_force()) continue;
    sums_.peak_force[k] = std::max(sums_.peak_force[k], forces[static_cast<Eigen::Index>(k)]);
  }
  sums_.largest_drift = std::max(sums_.largest_drift, constraints_->largest_gap(y_));
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const BodyPart& b = bodies_[k];
    sums_.largest_drift = std::max(sums_.largest_drift, std::abs(y_.segment<4>(b.quaternion()).norm() - 1.0));
    const double speed = b.state(y_).velocity.norm();
    if (speed > fastest_body)
      broken_ = fmt::format("{} moves at {:.4g} m/s; bodies are computed up to {:g} m/s", motion_.bodies[k].name, speed,
                            fastest_body);
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
ContactSample MotionRun::recorded(ContactSample sample, double time, std::size_t contact,
                                  const ContactTouches& touches) const {
  if (time == time_ || (!sample.closed && touches.held_states() < 2)) return sample;
  const auto force = [&](std::size_t i) {
    return forces_.at(time, static_cast<Eigen::Index>(i), std::max(2, touches.held_states()));
  };
  return with_force(std::move(sample), {force(3 * contact), force(3 * contact + 1), force(3 * contact + 2)},
                    force(3 * touching() + contact));
}

namespace {

WireLoads loads_of(wire::RodPart& rod, const DaePoint& at) {
  const auto [tensions, moments] = rod.section_loads(at);
  WireLoads loads{Eigen::Matrix3Xd(3, rod.vertices()), VectorXd(rod.vertices()),
                  moments / rod.model().properties().bending_stiffness};
  const Eigen::Index last = tensions.size() - 1;
  for (int i = 0; i < rod.vertices(); ++i) {
    loads.velocities.col(i) = at.y.segment<3>(rod.velocity_of(i));
    loads.tensions[i] = 0.5 * (tensions[std::max<Eigen::Index>(i - 1, 0)] + tensions[std::min<Eigen::Index>(i, last)]);
  }
  return loads;
}

}  // namespace

MotionSample MotionRun::sample(const DaePoint& at, const VectorXd& integrals) {
  MotionSample s;
  s.time = at.time;
  EnergyBalance e = stored(at, &s);
  // The polynomials through the last steps may overshoot between them; the dissipation only grows.
  e.dissipated = std::clamp(integrals[integral::dissipated] + law_losses_.at(at.time) + constraints_->lost(at.y),
                            lost_before_, lost_);
  e.work += integrals[integral::work];
  e.integrator = e.kinetic + e.strain + e.potential + e.dissipated - e.work - sums_.start_energy;
  e.corrected = corrected_;
  s.energy = e;
  for (const BodyPart& b : bodies_) s.bodies.push_back(b.state(at.y));
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    s.contacts.push_back(recorded(contacts_[k].sample(at.y), at.time, k, contacts_[k].touches()));
    const auto w = static_cast<std::size_t>(motion_.contacts[k].wire);
    const ContactPart::Sums sums = contacts_[k].sums(at.y);
    s.mount_forces[2 * w] -= sums.on_mounts[0];
    s.mount_forces[2 * w + 1] -= sums.on_mounts[1];
  }
  for (const LawPart& spring : point_contacts_) s.contacts.push_back(spring.sample(at));
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const std::size_t index = contacts_.size() + point_contacts_.size() + k;
    s.contacts.push_back(recorded(pairs_[k].sample(at.y), at.time, index, pairs_[k].touches()));
    const WirePairPart::Sums sums = pairs_[k].sums(at.y);
    for (std::size_t w = 0; w < 2; ++w) {
      for (std::size_t end = 0; end < 2; ++end)
        s.mount_forces[2 * base::at(motion_.wire_pairs[k].wires[w]) + end] -= sums.on_mounts[w][end];
    }
  }
  for (const UnilateralForcePart* p : unilateral_forces_) s.contacts.push_back(p->sample(at.y));
  if (options_.wire_loads) {
    for (wire::RodPart& r : rods_) s.wire_loads.push_back(loads_of(r, at));
  }
  for (const wire::RodPart& r : rods_) {
    Eigen::Matrix3Xd x(3, r.vertices());
    for (int i = 0; i < r.vertices(); ++i) x.col(i) = at.y.segment<3>(r.position_of(i));
    s.wires.push_back(std::move(x));
  }
  for (const LawWirePart& w : law_wires_) {
    LawWirePart::Shape shape = w.shape(at.y);
    s.wires.push_back(std::move(shape.points));
    for (const Vector3d& force : shape.mount_forces) s.mount_forces.push_back(force);
    s.law_tensions.push_back(shape.tension);
  }
  return s;
}

}  // namespace snare::coupling
