// Energy, momentum and what else is summed up along a motion.

#include "coupling/dynamics/run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;
using numerics::DaePoint;

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
  if (into != nullptr) constraints_->fill(at.y, *into);
  return e;
}

// Of a contact's force on its wire: what a driven body gives, with its work, and what goes on to rigidly held components,
// where it is no part of the rod's own reaction.
void MotionRun::add_reactions(std::size_t contact, const ContactPart::Sums& sums, const DaePoint& at,
                              Eigen::Ref<VectorXd> rates) const {
  const wire::RodPart& rod = rods_[static_cast<std::size_t>(motion_.contacts[contact].wire)];
  const BodyPart& body = bodies_[static_cast<std::size_t>(motion_.contacts[contact].body)];
  const std::array<int, 2> ends{rod.position_of(0), rod.position_of(rod.vertices() - 1)};
  for (std::size_t k = 0; k < 2; ++k) {
    rates.segment<3>(integral::outer) -= sums.on_mounts[k];
    rates.segment<3>(integral::outer_moment) -= Vector3d(at.y.segment<3>(ends[k])).cross(sums.on_mounts[k]);
  }
  if (body.moves_freely()) return;
  rates[integral::work] += sums.body_power;
  rates.segment<3>(integral::outer) += sums.force;
  rates.segment<3>(integral::outer_moment) += sums.moment;
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
  const auto touching = static_cast<Eigen::Index>(contacts_.size() + springs_.size());
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const ContactPart::Sums s = contacts_[k].sums(at.y);
    rates.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(k)) += s.force;
    rates[integral::contacts + 3 * touching + static_cast<Eigen::Index>(k)] = s.normal;
    rates[integral::dissipated] += s.lost_power;
    add_reactions(k, s, at, rates);
  }
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const ContactSample s = springs_[k].sample(at);
    rates.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(contacts_.size() + k)) = s.force;
    rates[integral::contacts + 3 * touching + static_cast<Eigen::Index>(contacts_.size() + k)] = s.normal_force;
    rates[integral::dissipated] += springs_[k].taken_power(at);
    rates[integral::work] -= s.normal_force * motion_.springs[k].origin_speed;
    rates.segment<3>(integral::outer) -= s.force;
    rates.segment<3>(integral::outer_moment) -= s.point.cross(s.force);
  }
  const ConstraintSet::Outer held = constraints_->outer(at);
  rates.segment<3>(integral::outer) += held.force;
  rates.segment<3>(integral::outer_moment) += held.moment;
  rates[integral::work] += held.power;
}

double MotionRun::longest_step() const {
  double step = std::numeric_limits<double>::infinity();
  for (const ContactGroup& c : contacts_) step = std::min(step, c.longest_step());
  return step;
}

// Extremes over the accepted steps, and what happened since the last one.
void MotionRun::watch(double time_before, const VectorXd& before) {
  const auto touching = static_cast<Eigen::Index>(contacts_.size() + springs_.size());
  VectorXd forces(touching);
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const ContactSample sum = contacts_[k].closed_sample(y_);
    for (MotionEvent& e : contacts_[k].observe(time_, sum, y_, time_before, before)) {
      e.contact = static_cast<int>(k);
      sums_.events.push_back(e);
    }
    forces[static_cast<Eigen::Index>(k)] = sum.normal_force;
    if (motion_.contacts[k].law) continue;
    for (const ContactSample& s : sum.points) sums_.largest_penetration = std::max(sums_.largest_penetration, -s.gap);
  }
  const DaePoint at{time_, y_, rate_};
  for (std::size_t k = 0; k < springs_.size(); ++k)
    forces[static_cast<Eigen::Index>(contacts_.size() + k)] = springs_[k].sample(at).normal_force;
  peak_.add(time_before, time_, forces, integrals_.tail(touching), sums_.peak_force);
  // Laws take no mass of the wire along at once.
  for (std::size_t k = 0; k < sums_.peak_force.size(); ++k) {
    if (k < contacts_.size() && !motion_.contacts[k].law) continue;
    sums_.peak_force[k] = std::max(sums_.peak_force[k], forces[static_cast<Eigen::Index>(k)]);
  }
  sums_.largest_drift = std::max(sums_.largest_drift, constraints_->largest_gap(y_));
  for (const BodyPart& b : bodies_) {
    sums_.largest_drift = std::max(sums_.largest_drift, std::abs(y_.segment<4>(b.quaternion()).norm() - 1.0));
  }
  for (const wire::RodPart& r : rods_) sums_.largest_drift = std::max(sums_.largest_drift, r.mount_error(y_));
  sums_.strength.resize(rods_.size());
  for (std::size_t w = 0; w < rods_.size(); ++w) {
    const MotionWire& wire = motion_.wires[w];
    if (const auto broken = watch_strength(wire.strength, rods_[w], at, sums_.strength[w]))
      broken_ = wire.name + *broken;
    if (!wire.rod.quasi_static) continue;
    const wire::RodPart::Energies e = rods_[w].energies(at);
    left_out_[w].add(time_, e.left_out_kinetic, e.left_out_momentum, sums_.left_out[w]);
  }
}

MotionSample MotionRun::sample(const DaePoint& at, const VectorXd& integrals) {
  MotionSample s;
  s.time = at.time;
  EnergyBalance e = stored(at, &s);
  e.dissipated += integrals[integral::dissipated];
  e.work += integrals[integral::work];
  e.integrator = e.kinetic + e.strain + e.potential + e.dissipated - e.work - sums_.start_energy;
  s.energy = e;
  for (const BodyPart& b : bodies_) s.bodies.push_back(b.state(at.y));
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    s.contacts.push_back(contacts_[k].sample(at.y));
    const auto w = static_cast<std::size_t>(motion_.contacts[k].wire);
    const ContactPart::Sums sums = contacts_[k].sums(at.y);
    s.mount_forces[2 * w] -= sums.on_mounts[0];
    s.mount_forces[2 * w + 1] -= sums.on_mounts[1];
  }
  for (const LawPart& spring : springs_) s.contacts.push_back(spring.sample(at));
  for (const wire::RodPart& r : rods_) {
    Eigen::Matrix3Xd x(3, r.vertices());
    for (int i = 0; i < r.vertices(); ++i) x.col(i) = at.y.segment<3>(r.position_of(i));
    s.wires.push_back(std::move(x));
  }
  return s;
}

}  // namespace snare::coupling
