#include "coupling/motion.hpp"

#include "coupling/motion_body.hpp"
#include "coupling/motion_contact.hpp"
#include "coupling/motion_spring.hpp"
#include "numerics/errors.hpp"
#include "wire/loose_wire.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;
using numerics::DaePoint;

namespace {

/// Collects what is wrong with a motion.
class Complaints {
 public:
  void require(bool fine, const std::string& key, double value, const std::string& requirement) {
    if (!fine) problems_.push_back({"", 0, key, fmt::format("{}", value), requirement});
  }
  void raise() {
    if (!problems_.empty()) throw numerics::InputError(problems_);
  }

 private:
  std::vector<numerics::InputProblem> problems_;
};

void validate(const Motion& motion, const MotionOptions& options) {
  Complaints c;
  const auto positive = [&c](const std::string& key, double value) {
    c.require(std::isfinite(value) && value > 0.0, key, value, "must be > 0");
  };
  positive("duration", options.duration);
  positive("output_interval", options.output_interval);
  positive("relative_tolerance", options.relative_tolerance);
  positive("position_tolerance", options.position_tolerance);
  positive("velocity_tolerance", options.velocity_tolerance);
  positive("twist_tolerance", options.twist_tolerance);
  positive("body_position_tolerance", options.body_position_tolerance);
  positive("body_velocity_tolerance", options.body_velocity_tolerance);
  positive("angle_tolerance", options.angle_tolerance);
  positive("spin_tolerance", options.spin_tolerance);
  positive("newton_share", options.newton_share);
  c.require(options.checkpoint_interval > 0.0, "checkpoint_interval", options.checkpoint_interval, "must be > 0");
  c.require(options.max_order >= 1 && options.max_order <= 5, "max_order", options.max_order,
            "must be 1 to 5");
  for (const MotionWire& w : motion.wires) {
    positive(w.name + ".length", w.rod.length);
    positive(w.name + ".mass_per_length", w.rod.mass_per_length);
    positive(w.name + ".axial_stiffness", w.rod.properties.axial_stiffness);
    positive(w.name + ".bending_stiffness", w.rod.properties.bending_stiffness);
    positive(w.name + ".torsional_stiffness", w.rod.properties.torsional_stiffness);
    c.require(w.rod.elements >= 4, w.name + ".elements", w.rod.elements, "must be >= 4");
    c.require(w.positions.cols() == w.rod.elements + 1, w.name + ".positions",
              static_cast<double>(w.positions.cols()), "must be one more than the elements");
    c.require(w.velocities.cols() == 0 || w.velocities.cols() == w.rod.elements + 1, w.name + ".velocities",
              static_cast<double>(w.velocities.cols()), "must be none or one more than the elements");
    c.require(w.positions.allFinite() && w.velocities.allFinite(), w.name + ".positions", std::nan(""),
              "must be finite");
  }
  for (const MotionBody& b : motion.bodies) {
    positive(b.name + ".mass", b.properties.mass);
    const Eigen::LLT<Eigen::Matrix3d> factor(b.properties.inertia);
    c.require(factor.info() == Eigen::Success, b.name + ".inertia", b.properties.inertia.trace(),
              "must be positive definite");
    c.require(static_cast<bool>(b.course_velocity) == static_cast<bool>(b.course_acceleration), b.name + ".course",
              b.course_velocity ? 1.0 : 0.0, "must have both velocity and acceleration, or none");
    c.require(std::abs(b.start.orientation.norm() - 1.0) < 1e-9, b.name + ".orientation",
              b.start.orientation.norm(), "must be a unit quaternion");
  }
  for (const MotionContact& k : motion.contacts) {
    c.require(k.wire >= 0 && k.wire < static_cast<int>(motion.wires.size()), k.name + ".wire", k.wire,
              "must be the index of a wire");
    c.require(k.body >= 0 && k.body < static_cast<int>(motion.bodies.size()), k.name + ".body", k.body,
              "must be the index of a body");
    c.require(k.shape != nullptr, k.name + ".shape", 0.0, "must be given");
    c.require(k.friction.static_speed > 0.0 && k.friction.dynamic_speed > k.friction.static_speed,
              k.name + ".friction.static_speed", k.friction.static_speed, "must be > 0 and < dynamic_speed");
  }
  for (const MotionSpring& s : motion.springs) {
    c.require(s.body >= 0 && s.body < static_cast<int>(motion.bodies.size()), s.name + ".body", s.body,
              "must be the index of a body");
    c.require(std::abs(s.direction.norm() - 1.0) < 1e-12, s.name + ".direction", s.direction.norm(),
              "must be a unit vector");
    c.require(static_cast<bool>(s.law), s.name + ".law", 0.0, "must be given");
  }
  c.raise();
}

/// Where the integrals along the run stand: powers [W], sums of all outer forces [N] and moments about the origin [N m] on
/// wires and free bodies, and the force of every contact on its wire and of every body on its spring [N].
namespace integral {
constexpr Eigen::Index dissipated = 0;
constexpr Eigen::Index work = 1;
constexpr Eigen::Index outer = 2;
constexpr Eigen::Index outer_moment = 5;
constexpr Eigen::Index contacts = 8;
}  // namespace integral

class Run {
 public:
  Run(const Motion& motion, const MotionOptions& options, const MotionObserver& observer);
  void begin();
  void resume(const MotionState& from);
  /// Goes on to `limit` [s].
  MotionResult go(double limit);

 private:
  [[nodiscard]] std::vector<numerics::DaePart*> parts();
  void make_rates();
  void close(int contact);
  void settle();
  [[nodiscard]] MotionSample sample(const DaePoint& at, const VectorXd& integrals);
  [[nodiscard]] EnergyBalance stored(const DaePoint& at, MotionSample* into);
  void integrands(const DaePoint& at, Eigen::Ref<VectorXd> rates);
  void watch();
  void add_reactions(std::size_t contact, const Vector3d& force, const DaePoint& at, Eigen::Ref<VectorXd> rates) const;
  [[nodiscard]] bool write_until(double time);
  [[nodiscard]] MotionResult result(numerics::IdaReport report);

  const Motion& motion_;
  MotionOptions options_;
  const MotionObserver& observer_;
  std::deque<wire::RodPart> rods_;
  std::deque<BodyPart> bodies_;
  std::deque<ContactPart> contacts_;
  std::deque<SpringPart> springs_;
  std::unique_ptr<numerics::DaeSystem> system_;
  std::unique_ptr<numerics::Ida> ida_;
  VectorXd y_, rate_;
  VectorXd integrals_;
  double time_ = 0.0;
  MotionSums sums_;
};

Run::Run(const Motion& motion, const MotionOptions& options, const MotionObserver& observer)
    : motion_(motion), options_(options), observer_(observer) {
  for (const MotionWire& w : motion.wires) {
    wire::RodInMotion rod = w.rod;
    rod.properties.weight = rod.mass_per_length * motion.gravity;
    rods_.emplace_back(
        w.name, rod,
        wire::RodTolerances{options.position_tolerance, options.velocity_tolerance, options.twist_tolerance});
  }
  for (const MotionBody& b : motion.bodies) bodies_.emplace_back(b, motion.gravity, options);
  for (const MotionContact& c : motion.contacts) {
    contacts_.emplace_back(c, rods_[static_cast<std::size_t>(c.wire)],
                           bodies_[static_cast<std::size_t>(c.body)], options);
  }
  for (const MotionSpring& s : motion.springs) springs_.emplace_back(s, bodies_[static_cast<std::size_t>(s.body)]);
  system_ = std::make_unique<numerics::DaeSystem>(parts());
  y_ = VectorXd::Zero(system_->size());
  rate_ = y_;
  for (std::size_t i = 0; i < rods_.size(); ++i)
    rods_[i].place(motion.wires[i].positions, motion.wires[i].velocities, y_);
  for (const BodyPart& b : bodies_) b.place(y_);
  for (ContactPart& c : contacts_) {
    y_[c.coordinate_unknown()] = c.nearest(y_).coordinate;
    c.open(y_);
  }
  numerics::IdaOptions ida;
  ida.relative_tolerance = options.relative_tolerance;
  ida.max_order = options.max_order;
  ida.max_step = options.max_step;
  ida.newton_test = numerics::NewtonTest::every_unknown;
  ida.newton_share = options.newton_share;
  const auto touching = static_cast<int>(contacts_.size() + springs_.size());
  integrals_ = VectorXd::Zero(integral::contacts + 3 * touching);
  ida_ = std::make_unique<numerics::Ida>(
      *system_, ida,
      numerics::IdaIntegrals{static_cast<int>(integrals_.size()),
                             [this](const DaePoint& at, Eigen::Ref<VectorXd> rates) { integrands(at, rates); }});
  sums_.peak_force.assign(static_cast<std::size_t>(touching), 0.0);
}

std::vector<numerics::DaePart*> Run::parts() {
  std::vector<numerics::DaePart*> list;
  for (auto& r : rods_) list.push_back(&r);
  for (auto& b : bodies_) list.push_back(&b);
  for (auto& c : contacts_) list.push_back(&c);
  for (auto& s : springs_) list.push_back(&s);
  return list;
}

// With all accelerations and constraint forces zero the rows are minus the forces; what the constraints then miss in
// d2g/dt2 = 0 gives their forces.                                                              theory.md (M.10)
void Run::make_rates() {
  rate_.setZero();
  for (const wire::RodPart& r : rods_) {
    for (int i = 0; i < r.vertices(); ++i)
      rate_.segment<3>(r.position_of(i)) = y_.segment<3>(r.velocity_of(i));
  }
  for (const BodyPart& b : bodies_) {
    rate_.segment<3>(b.position()) = y_.segment<3>(b.velocity());
    rate_.segment<4>(b.quaternion()) =
        multibody::quaternion_rates(y_.segment<4>(b.quaternion())) * y_.segment<3>(b.spin());
  }
  std::vector<const ContactPart*> constraints;
  for (const ContactPart& c : contacts_) {
    y_[c.force_unknown()] = 0.0;
    if (c.closed() && !c.has_law()) constraints.push_back(&c);
  }
  VectorXd rows(system_->size());
  system_->residual({time_, y_, rate_}, rows);
  for (const ContactPart& c : contacts_) {
    if (c.closed() && c.has_law()) y_[c.force_unknown()] = -rows[c.force_unknown()];
  }
  system_->residual({time_, y_, rate_}, rows);
  for (const wire::RodPart& r : rods_) {
    for (int i = 0; i < r.vertices(); ++i) {
      for (int k = 0; k < 3; ++k) {
        if (!r.is_held(i, k)) rate_[r.velocity_of(i) + k] = -rows[r.velocity_of(i) + k] / r.mass_of(i);
      }
    }
  }
  for (const BodyPart& b : bodies_) {
    if (!b.moves_freely()) {
      rate_.segment<3>(b.velocity()) = b.course_acceleration(time_);
      continue;
    }
    rate_.segment<3>(b.velocity()) = -rows.segment<3>(b.velocity()) / b.body().properties.mass;
    rate_.segment<3>(b.spin()) = -b.inverse_inertia() * rows.segment<3>(b.spin());
  }
  const auto n = static_cast<Eigen::Index>(constraints.size());
  if (n == 0) return;
  Eigen::MatrixXd flexibility(n, n);
  VectorXd missing(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ContactPart& c = *constraints[static_cast<std::size_t>(i)];
    missing[i] = -(c.gap_rate_of(y_, rate_) + c.gap_acceleration_at_rest(y_));
    VectorXd unit = VectorXd::Zero(y_.size());
    c.respond(y_, 1.0, unit);
    for (Eigen::Index j = 0; j < n; ++j)
      flexibility(j, i) = constraints[static_cast<std::size_t>(j)]->gap_rate_of(y_, unit);
  }
  const VectorXd force = flexibility.partialPivLu().solve(missing);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ContactPart& c = *constraints[static_cast<std::size_t>(i)];
    y_[c.force_unknown()] = force[i];
    c.respond(y_, force[i], rate_);
  }
}

// The wire's local masses take on the body's normal velocity at once (no restitution): the impulse that makes dg/dt = 0
// at all closed contacts. What is lost vanishes with the element's mass.                            theory.md (M.10)
void Run::close(int contact) {
  ContactPart& touched = contacts_[static_cast<std::size_t>(contact)];
  if (touched.close(y_)) system_->invalidate_pattern();
  sums_.events.push_back({time_, contact, MotionEvent::Kind::touch, -touched.gap_rate(y_)});
  if (touched.has_law()) return;
  std::vector<const ContactPart*> constraints;
  std::vector<std::size_t> index;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!contacts_[k].closed() || contacts_[k].has_law()) continue;
    constraints.push_back(&contacts_[k]);
    index.push_back(k);
  }
  const auto n = static_cast<Eigen::Index>(constraints.size());
  Eigen::MatrixXd flexibility(n, n);
  VectorXd missing(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    missing[i] = -constraints[static_cast<std::size_t>(i)]->gap_rate(y_);
    VectorXd unit = VectorXd::Zero(y_.size());
    constraints[static_cast<std::size_t>(i)]->respond(y_, 1.0, unit);
    for (Eigen::Index j = 0; j < n; ++j)
      flexibility(j, i) = constraints[static_cast<std::size_t>(j)]->gap_rate_of(y_, unit);
  }
  const VectorXd impulse = flexibility.partialPivLu().solve(missing);
  const double before = stored({time_, y_, rate_}, nullptr).kinetic;
  const double worked = integrals_[integral::work];
  for (std::size_t i = 0; i < index.size(); ++i) {
    const double p = impulse[static_cast<Eigen::Index>(i)];
    const Vector3d along = p * constraints[i]->normal(y_);
    integrals_.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(index[i])) += along;
    add_reactions(index[i], along, {time_, y_, rate_}, integrals_);
    constraints[i]->respond(y_, p, y_);
  }
  sums_.impacts += before + integrals_[integral::work] - worked - stored({time_, y_, rate_}, nullptr).kinetic;
}

// Contacts that would pull let go at once.
void Run::settle() {
  make_rates();
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!contacts_[k].closed() || y_[contacts_[k].force_unknown()] >= -options_.force_tolerance) continue;
    if (contacts_[k].has_law()) continue;
    contacts_[k].open(y_);
    sums_.events.push_back({time_, static_cast<int>(k), MotionEvent::Kind::lift_off, 0.0});
    make_rates();
  }
  ida_->set_integrals(integrals_);
  ida_->start(time_, y_, rate_);
}

EnergyBalance Run::stored(const DaePoint& at, MotionSample* into) {
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
  for (const BodyPart& b : bodies_) {
    if (!b.moves_freely()) continue;
    const multibody::RigidBodyState s = b.state(at.y);
    e.kinetic += multibody::kinetic_energy(b.body().properties, s);
    e.potential -= b.body().properties.mass * motion_.gravity.dot(s.position);
    if (into == nullptr) continue;
    into->momentum += b.body().properties.mass * s.velocity;
    into->angular_momentum += multibody::angular_momentum(b.body().properties, s);
  }
  return e;
}

// Of a contact's force (or impulse) on its wire: what a driven body gives, with its work, and what goes on to rigidly
// held components, where it is no part of the rod's own reaction.
void Run::add_reactions(std::size_t contact, const Vector3d& force, const DaePoint& at,
                        Eigen::Ref<VectorXd> rates) const {
  const ContactPart& c = contacts_[contact];
  const wire::RodPart& rod = rods_[static_cast<std::size_t>(motion_.contacts[contact].wire)];
  const BodyPart& body = bodies_[static_cast<std::size_t>(motion_.contacts[contact].body)];
  const auto outer = [&rates](const Vector3d& f, const Vector3d& point) {
    rates.segment<3>(integral::outer) += f;
    rates.segment<3>(integral::outer_moment) += point.cross(f);
  };
  const std::array<Vector3d, 2> held = c.share_of_mounts(at.y, force);
  outer(-held[0], at.y.segment<3>(rod.position_of(0)));
  outer(-held[1], at.y.segment<3>(rod.position_of(rod.vertices() - 1)));
  if (body.moves_freely()) return;
  rates[integral::work] += force.dot(at.y.segment<3>(body.velocity()));
  outer(force, c.sample(at).point);
}

void Run::integrands(const DaePoint& at, Eigen::Ref<VectorXd> rates) {
  for (wire::RodPart& rod : rods_) {
    const wire::RodPart::Energies w = rod.energies(at);
    const wire::RodInMotion& c = rod.constants();
    rates[integral::dissipated] += w.dissipation;
    rates.segment<3>(integral::outer) += w.mount_forces[0] + w.mount_forces[1] +
                                         c.mass_per_length * c.length * motion_.gravity -
                                         c.damping.mass_rate * w.momentum;
    rates.segment<3>(integral::outer_moment) += w.mount_moments[0] + w.mount_moments[1] + w.weight_moment -
                                                c.damping.mass_rate * w.angular_momentum;
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
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!contacts_[k].closed()) continue;
    const Vector3d force = contacts_[k].sample(at).force;
    rates.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(k)) = force;
    rates[integral::dissipated] += contacts_[k].lost_power(at.y);
    add_reactions(k, force, at, rates);
  }
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const ContactSample s = springs_[k].sample(at.y);
    rates.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(contacts_.size() + k)) = s.force;
    rates[integral::dissipated] += springs_[k].taken_power(at.y);
    rates.segment<3>(integral::outer) -= s.force;
    rates.segment<3>(integral::outer_moment) -= s.point.cross(s.force);
  }
}

// Extremes over the accepted steps.
void Run::watch() {
  const DaePoint at{time_, y_, rate_};
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!contacts_[k].closed()) continue;
    const ContactSample s = contacts_[k].sample(at);
    sums_.peak_force[k] = std::max(sums_.peak_force[k], s.normal_force);
    if (contacts_[k].has_law()) continue;
    sums_.largest_penetration = std::max(sums_.largest_penetration, -s.gap);
    sums_.largest_gap = std::max(sums_.largest_gap, std::abs(s.gap));
  }
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    double& peak = sums_.peak_force[contacts_.size() + k];
    peak = std::max(peak, springs_[k].sample(y_).normal_force);
  }
  for (const BodyPart& b : bodies_) {
    sums_.largest_drift = std::max(sums_.largest_drift, std::abs(y_.segment<4>(b.quaternion()).norm() - 1.0));
  }
  for (const wire::RodPart& r : rods_) sums_.largest_drift = std::max(sums_.largest_drift, r.mount_error(y_));
}

MotionSample Run::sample(const DaePoint& at, const VectorXd& integrals) {
  MotionSample s;
  s.time = at.time;
  EnergyBalance e = stored(at, &s);
  e.dissipated = integrals[integral::dissipated];
  e.impacts = sums_.impacts;
  e.work = integrals[integral::work];
  e.integrator = e.kinetic + e.strain + e.potential + e.dissipated + e.impacts - e.work - sums_.start_energy;
  s.energy = e;
  for (const BodyPart& b : bodies_) s.bodies.push_back(b.state(at.y));
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    s.contacts.push_back(contacts_[k].sample(at));
    const std::array<Vector3d, 2> held = contacts_[k].force_on_mounts(at.y);
    const auto w = static_cast<std::size_t>(motion_.contacts[k].wire);
    s.mount_forces[2 * w] -= held[0];
    s.mount_forces[2 * w + 1] -= held[1];
  }
  for (const SpringPart& spring : springs_) s.contacts.push_back(spring.sample(at.y));
  for (const wire::RodPart& r : rods_) {
    Eigen::Matrix3Xd x(3, r.vertices());
    for (int i = 0; i < r.vertices(); ++i) x.col(i) = at.y.segment<3>(r.position_of(i));
    s.wires.push_back(std::move(x));
  }
  return s;
}

bool Run::write_until(double time) {
  if (!observer_) return false;
  while (static_cast<double>(sums_.samples) * options_.output_interval <= time) {
    const double t = static_cast<double>(sums_.samples) * options_.output_interval;
    ++sums_.samples;
    if (t == time_) {
      if (observer_(sample({t, y_, rate_}, integrals_))) return true;
      continue;
    }
    const VectorXd y = ida_->interpolate(t);
    const VectorXd rate = ida_->interpolate(t, 1);
    if (observer_(sample({t, y, rate}, ida_->interpolate_integrals(t)))) return true;
  }
  return false;
}

void Run::begin() {
  MotionSample start;
  const EnergyBalance energy = stored({0.0, y_, rate_}, &start);
  sums_.start_energy = energy.kinetic + energy.strain + energy.potential;
  sums_.start_momentum = start.momentum;
  sums_.start_angular_momentum = start.angular_momentum;
  settle();
}

void Run::resume(const MotionState& from) {
  if (from.unknowns.size() != y_.size() || from.rates.size() != y_.size() ||
      from.integrals.size() != integrals_.size() || from.sums.peak_force.size() != sums_.peak_force.size()) {
    throw numerics::InputError({"", 0, "state", fmt::format("{} unknowns", from.unknowns.size()),
                                fmt::format("must be that of the same motion, of {} unknowns", y_.size())});
  }
  time_ = from.time;
  y_ = from.unknowns;
  rate_ = from.rates;
  integrals_ = from.integrals;
  sums_ = from.sums;
  system_->recall(y_, from.memory);
  ida_->set_integrals(integrals_);
  ida_->start(time_, y_, rate_);
}

MotionResult Run::go(double limit) {
  const auto clock = std::chrono::steady_clock::now();
  numerics::IdaReport report;
  bool stopped = write_until(time_);
  while (!stopped && time_ < limit) {
    const numerics::IdaAdvance advance = ida_->advance(limit);
    report = ida_->report();
    if (advance == numerics::IdaAdvance::failed) break;
    time_ = ida_->time();
    y_ = ida_->y();
    rate_ = ida_->rate();
    integrals_ = ida_->integrals();
    watch();
    stopped = write_until(time_) || (options_.stop && options_.stop());
    if (advance != numerics::IdaAdvance::event) continue;
    bool changed = false;
    const std::vector<int> found = ida_->events_found();
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      if (found[k] >= 0) continue;  // only a falling gap or force is an event
      changed = true;
      if (contacts_[k].closed()) {
        contacts_[k].open(y_);
        sums_.events.push_back({time_, static_cast<int>(k), MotionEvent::Kind::lift_off, 0.0});
      } else {
        close(static_cast<int>(k));
      }
    }
    for (std::size_t k = 0; k < springs_.size(); ++k) {
      const std::size_t event = contacts_.size() + k;
      if (found[event] == 0) continue;
      changed = true;
      const bool touch = found[event] > 0;
      sums_.events.push_back({time_, static_cast<int>(event), touch ? MotionEvent::Kind::touch : MotionEvent::Kind::lift_off,
                              0.0});
    }
    if (changed) settle();
    if (static_cast<int>(sums_.events.size()) > options_.max_events) {
      report.termination = numerics::Termination::iteration_limit;
      report.message = fmt::format("more than {} contact events by {:.9g} s", options_.max_events, time_);
      break;
    }
  }
  if (stopped && report.usable()) {
    report.termination = numerics::Termination::interrupted;
    report.message = fmt::format("stopped on request at {:.9g} s", time_);
  }
  report.time = time_;
  sums_.statistics += ida_->statistics();
  sums_.wall_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return result(std::move(report));
}

MotionResult Run::result(numerics::IdaReport report) {
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
  r.largest_penetration = sums_.largest_penetration;
  r.largest_gap = sums_.largest_gap;
  r.largest_drift = sums_.largest_drift;
  r.statistics = sums_.statistics;
  r.wall_seconds = sums_.wall_seconds;
  r.last = {time_, y_, rate_, integrals_, system_->memory(), sums_};
  return r;
}

/// The first checkpoint behind a time, or the end when none comes before it.
double next_stop(const MotionOptions& options, double time) {
  constexpr double round_off = 1e-9;  // of an interval
  const double interval = options.checkpoint_interval;
  if (!std::isfinite(interval)) return options.duration;
  const double stop = (std::floor(time / interval + round_off) + 1.0) * interval;
  return stop < options.duration - round_off * interval ? stop : options.duration;
}

}  // namespace

wire::RodInMotion rod_in_motion(const wire::WireSpecification& specification, double span, int elements) {
  wire::RodInMotion rod;
  rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = specification.bending_stiffness();
  rod.properties.torsional_stiffness = specification.torsional_stiffness();
  rod.properties.axial_stiffness = specification.axial_stiffness();
  rod.properties.right.position = {span, 0.0, 0.0};
  rod.mass_per_length = specification.mass_per_length();
  rod.length = specification.length;
  rod.elements = elements;
  return rod;
}

Eigen::Matrix3Xd straight_wire(const wire::RodInMotion& rod, const Vector3d& from, const Vector3d& to) {
  const wire::MaterialMesh mesh(rod.elements / 2, rod.elements - rod.elements / 2, rod.grading);
  const wire::Controls controls{0.0, rod.length * (rod.elements / 2) / rod.elements, rod.length};
  Eigen::Matrix3Xd x(3, mesh.vertices());
  for (int i = 0; i < mesh.vertices(); ++i)
    x.col(i) = from + mesh.coordinate(i, controls) / rod.length * (to - from);
  return x;
}

Eigen::Matrix3Xd resting_wire(const wire::RodInMotion& rod) {
  const Vector3d from = rod.properties.left.position;
  const Vector3d to = rod.properties.right.position;
  if (rod.length <= (to - from).norm()) return straight_wire(rod, from, to);
  wire::PlanarRodProperties plane;
  plane.bending_stiffness = rod.properties.bending_stiffness;
  plane.axial_stiffness = rod.properties.axial_stiffness;
  plane.right.position = {(to - from).norm(), 0.0};
  const wire::PlanarRod planar(wire::MaterialMesh(rod.elements / 2, rod.elements - rod.elements / 2, rod.grading), plane);
  const wire::Controls controls{0.0, rod.length * (rod.elements / 2) / rod.elements, rod.length};
  const wire::LooseWire loose = wire::find_loose_wire(planar, controls, 1);
  if (!loose.report.usable()) throw numerics::InputError({"", 0, "wire", "", loose.report.message});
  const Vector3d along = (to - from).normalized();
  Vector3d up = Vector3d::UnitY() - along.y() * along;
  if (up.norm() < 1e-6) up = Vector3d::UnitX() - along.x() * along;
  up.normalize();
  Eigen::Matrix3Xd x(3, rod.elements + 1);
  for (int i = 0; i <= rod.elements; ++i) {
    const Eigen::Vector2d p = wire::vertex(loose.state, i);
    x.col(i) = from + p.x() * along + p.y() * up;
  }
  return x;
}

MotionResult simulate(const Motion& motion, const MotionOptions& options, const MotionObserver& observer,
                      const MotionState* from, const MotionKeeper& keeper) {
  validate(motion, options);
  std::optional<MotionState> state;
  if (from != nullptr) state = *from;
  // Every leg between two checkpoints is a run of its own that knows the state alone: whether the legs are those of one
  // process or of several makes no difference.
  for (;;) {
    Run run(motion, options, observer);
    if (state) {
      run.resume(*state);
    } else {
      run.begin();
    }
    const double stop = next_stop(options, state ? state->time : 0.0);
    MotionResult result = run.go(stop);
    if (!result.report.usable() || result.report.time < stop || stop >= options.duration) return result;
    state = std::move(result.last);
    if (keeper) keeper(*state);
  }
}

}  // namespace snare::coupling
