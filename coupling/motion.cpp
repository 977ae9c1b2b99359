#include "coupling/motion.hpp"

#include "coupling/motion_body.hpp"
#include "coupling/motion_contact.hpp"
#include "coupling/motion_linkage.hpp"
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
#include <span>

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
  std::vector<numerics::InputProblem>& problems() { return problems_; }
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
  Linkage::check(motion, c.problems());
  c.raise();
}

/// Powers and forces at one time, whose integrals along the run are kept.
struct Rates {
  double dissipated = 0.0;            // [W]
  double work = 0.0;                  // [W]
  Vector3d outer = Vector3d::Zero();  // sum of all outer forces on wires and free bodies [N]
  std::vector<Vector3d> contact;      // on the wires [N]
};

class Run {
 public:
  Run(const Motion& motion, const MotionOptions& options, const MotionObserver& observer);
  MotionResult go();

 private:
  [[nodiscard]] std::vector<numerics::DaePart*> parts();
  void make_rates();
  void close(int contact);
  void settle();
  [[nodiscard]] MotionSample sample(const DaePoint& at);
  [[nodiscard]] EnergyBalance stored(const DaePoint& at, MotionSample* into);
  [[nodiscard]] Rates rates(const DaePoint& at);
  void account(const Rates& now, double time);
  [[nodiscard]] bool write_until(double time);

  const Motion& motion_;
  MotionOptions options_;
  const MotionObserver& observer_;
  std::deque<wire::RodPart> rods_;
  std::deque<BodyPart> bodies_;
  std::deque<ContactPart> contacts_;
  std::deque<SpringPart> springs_;
  std::optional<Linkage> linkage_;
  std::unique_ptr<numerics::DaeSystem> system_;
  std::unique_ptr<numerics::Ida> ida_;
  VectorXd y_, rate_;
  double time_ = 0.0;
  MotionResult result_;
  double start_energy_ = 0.0;
  Vector3d start_momentum_ = Vector3d::Zero();
  Vector3d outer_impulse_ = Vector3d::Zero();
  Rates last_;
  double last_time_ = 0.0;
  long written_ = 0;
};

Run::Run(const Motion& motion, const MotionOptions& options, const MotionObserver& observer)
    : motion_(motion), options_(options), observer_(observer) {
  for (const MotionWire& w : motion.wires) {
    wire::RodInMotion rod = w.rod;
    rod.properties.weight = rod.mass_per_length * motion.gravity;
    rods_.emplace_back(
        w.name, rod,
        wire::RodTolerances{options.position_tolerance, options.velocity_tolerance, options.angle_tolerance});
  }
  for (const MotionBody& b : motion.bodies) bodies_.emplace_back(b, motion.gravity, options);
  for (const MotionContact& c : motion.contacts) {
    contacts_.emplace_back(c, rods_[static_cast<std::size_t>(c.wire)],
                           bodies_[static_cast<std::size_t>(c.body)], options);
  }
  for (const MotionSpring& s : motion.springs) springs_.emplace_back(s, bodies_[static_cast<std::size_t>(s.body)]);
  linkage_.emplace(motion, rods_, bodies_, options);
  system_ = std::make_unique<numerics::DaeSystem>(parts());
  y_ = VectorXd::Zero(system_->size());
  rate_ = y_;
  for (std::size_t i = 0; i < rods_.size(); ++i)
    rods_[i].place(motion.wires[i].positions, motion.wires[i].velocities, y_);
  for (const BodyPart& b : bodies_) b.place(y_);
  linkage_->place(y_);
  for (ContactPart& c : contacts_) {
    y_[c.coordinate_unknown()] = c.nearest(y_).coordinate;
    c.open(y_);
  }
  numerics::IdaOptions ida;
  ida.relative_tolerance = options.relative_tolerance;
  ida.max_order = options.max_order;
  ida.max_step = options.max_step;
  ida_ = std::make_unique<numerics::Ida>(*system_, ida);
  result_.peak_force.assign(contacts_.size() + springs_.size(), 0.0);
  result_.impulse.assign(contacts_.size() + springs_.size(), Vector3d::Zero());
}

std::vector<numerics::DaePart*> Run::parts() {
  std::vector<numerics::DaePart*> list;
  for (auto& r : rods_) list.push_back(&r);
  for (auto& b : bodies_) list.push_back(&b);
  for (auto& c : contacts_) list.push_back(&c);
  for (auto& s : springs_) list.push_back(&s);
  linkage_->append(list);
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
  linkage_->loosen(y_);
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
    if (!b.moves_freely()) continue;
    rate_.segment<3>(b.velocity()) = -rows.segment<3>(b.velocity()) / b.body().properties.mass;
    rate_.segment<3>(b.spin()) = -b.inverse_inertia() * rows.segment<3>(b.spin());
  }
  linkage_->solve_rates(y_, rows, rate_);
  const auto n = static_cast<Eigen::Index>(constraints.size());
  if (n == 0) {
    linkage_->set_multipliers(linkage_->hold_rates(y_, rate_), y_);
    return;
  }
  VectorXd held_rate = rate_;
  static_cast<void>(linkage_->hold_rates(y_, held_rate));
  Eigen::MatrixXd flexibility(n, n);
  VectorXd missing(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ContactPart& c = *constraints[static_cast<std::size_t>(i)];
    missing[i] = -(c.gap_rate_of(y_, held_rate) + c.gap_acceleration_at_rest(y_));
    VectorXd unit = VectorXd::Zero(y_.size());
    c.respond(y_, 1.0, unit);
    linkage_->hold(y_, unit);
    for (Eigen::Index j = 0; j < n; ++j)
      flexibility(j, i) = constraints[static_cast<std::size_t>(j)]->gap_rate_of(y_, unit);
  }
  const VectorXd force = flexibility.partialPivLu().solve(missing);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ContactPart& c = *constraints[static_cast<std::size_t>(i)];
    y_[c.force_unknown()] = force[i];
    c.respond(y_, force[i], rate_);
  }
  linkage_->set_multipliers(linkage_->hold_rates(y_, rate_), y_);
}

// The wire's local masses take on the body's normal velocity at once (no restitution): the impulse that makes dg/dt = 0
// at all closed contacts. What is lost vanishes with the element's mass.                            theory.md (M.10)
void Run::close(int contact) {
  ContactPart& touched = contacts_[static_cast<std::size_t>(contact)];
  if (touched.close(y_)) system_->invalidate_pattern();
  result_.events.push_back({time_, contact, MotionEvent::Kind::touch, -touched.gap_rate(y_)});
  if (touched.has_law()) return;
  std::vector<const ContactPart*> constraints;
  for (const ContactPart& c : contacts_) {
    if (c.closed() && !c.has_law()) constraints.push_back(&c);
  }
  const auto n = static_cast<Eigen::Index>(constraints.size());
  Eigen::MatrixXd flexibility(n, n);
  VectorXd missing(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    missing[i] = -constraints[static_cast<std::size_t>(i)]->gap_rate(y_);
    VectorXd unit = VectorXd::Zero(y_.size());
    constraints[static_cast<std::size_t>(i)]->respond(y_, 1.0, unit);
    linkage_->hold(y_, unit);
    for (Eigen::Index j = 0; j < n; ++j)
      flexibility(j, i) = constraints[static_cast<std::size_t>(j)]->gap_rate_of(y_, unit);
  }
  const VectorXd impulse = flexibility.partialPivLu().solve(missing);
  const double before = stored({time_, y_, rate_}, nullptr).kinetic;
  VectorXd change = VectorXd::Zero(y_.size());
  for (Eigen::Index i = 0; i < n; ++i) constraints[static_cast<std::size_t>(i)]->respond(y_, impulse[i], change);
  linkage_->hold(y_, change);
  y_ += change;
  result_.energy.impacts += before - stored({time_, y_, rate_}, nullptr).kinetic;
}

// Contacts that would pull let go at once.
void Run::settle() {
  make_rates();
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!contacts_[k].closed() || y_[contacts_[k].force_unknown()] >= -options_.force_tolerance) continue;
    if (contacts_[k].has_law()) continue;
    contacts_[k].open(y_);
    result_.events.push_back({time_, static_cast<int>(k), MotionEvent::Kind::lift_off, 0.0});
    make_rates();
  }
  ida_->start(time_, y_, rate_);
  last_ = rates({time_, y_, rate_});
  last_time_ = time_;
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
  linkage_->add_energy(at.y, e, into);
  if (into != nullptr) linkage_->fill(at.y, *into);
  return e;
}

Rates Run::rates(const DaePoint& at) {
  Rates r;
  for (std::size_t i = 0; i < rods_.size(); ++i) {
    const wire::RodPart::Energies w = rods_[i].energies(at);
    const wire::RodInMotion& c = rods_[i].constants();
    r.dissipated += w.dissipation;
    r.outer += w.mount_forces[0] + w.mount_forces[1] + c.mass_per_length * c.length * motion_.gravity -
               c.damping.mass_rate * w.momentum;
  }
  for (const BodyPart& b : bodies_) {
    if (!b.moves_freely()) continue;
    r.dissipated += b.drag_power(at.y);
    r.work += b.force_power(at.y);
    r.outer += b.body().force + b.body().properties.mass * motion_.gravity -
               b.body().linear_drag * at.y.segment<3>(b.velocity());
  }
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const ContactSample s = contacts_[k].sample(at);
    const BodyPart& body = bodies_[static_cast<std::size_t>(motion_.contacts[k].body)];
    r.contact.push_back(s.force);
    r.dissipated += contacts_[k].lost_power(at.y);
    const std::array<Vector3d, 2> held = contacts_[k].force_on_mounts(at.y);
    r.outer -= held[0] + held[1];
    if (!body.moves_freely()) {
      r.work += s.force.dot(at.y.segment<3>(body.velocity()));
      r.outer += s.force;
    }
    if (s.closed) {
      result_.peak_force[k] = std::max(result_.peak_force[k], s.normal_force);
      if (!contacts_[k].has_law())
        result_.largest_penetration = std::max(result_.largest_penetration, -s.gap);
    }
  }
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const ContactSample s = springs_[k].sample(at.y);
    r.contact.push_back(s.force);
    r.dissipated += springs_[k].taken_power(at.y);
    r.outer -= s.force;
    double& peak = result_.peak_force[contacts_.size() + k];
    peak = std::max(peak, s.normal_force);
  }
  const Linkage::Outer linked = linkage_->outer(at);
  r.outer += linked.force;
  r.work += linked.power;
  result_.largest_drift = std::max(result_.largest_drift, linkage_->largest_gap(at.y));
  for (const BodyPart& b : bodies_) {
    result_.largest_drift =
        std::max(result_.largest_drift, std::abs(at.y.segment<4>(b.quaternion()).norm() - 1.0));
  }
  return r;
}

void Run::account(const Rates& now, double time) {
  const double half = 0.5 * (time - last_time_);
  result_.energy.dissipated += half * (last_.dissipated + now.dissipated);
  result_.energy.work += half * (last_.work + now.work);
  outer_impulse_ += half * (last_.outer + now.outer);
  for (std::size_t k = 0; k < result_.impulse.size(); ++k)
    result_.impulse[k] += half * (last_.contact[k] + now.contact[k]);
  last_ = now;
  last_time_ = time;
}

MotionSample Run::sample(const DaePoint& at) {
  MotionSample s;
  s.time = at.time;
  EnergyBalance e = stored(at, &s);
  e.dissipated += result_.energy.dissipated;
  e.impacts = result_.energy.impacts;
  e.work += result_.energy.work;
  e.integrator = e.kinetic + e.strain + e.potential + e.dissipated + e.impacts - e.work - start_energy_;
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
  while (static_cast<double>(written_) * options_.output_interval <= time) {
    const double t = static_cast<double>(written_) * options_.output_interval;
    ++written_;
    const VectorXd y = t == time_ ? y_ : ida_->interpolate(t);
    const VectorXd rate = t == time_ ? rate_ : ida_->interpolate(t, 1);
    if (observer_(sample({t, y, rate}))) return true;
  }
  return false;
}

MotionResult Run::go() {
  const auto clock = std::chrono::steady_clock::now();
  MotionSample start;
  const EnergyBalance energy = stored({0.0, y_, rate_}, &start);
  start_energy_ = energy.kinetic + energy.strain + energy.potential;
  start_momentum_ = start.momentum;
  bool stopped = false;
  settle();
  stopped = write_until(0.0);
  while (!stopped) {
    const numerics::IdaAdvance advance = ida_->advance(linkage_->limit());
    if (advance == numerics::IdaAdvance::failed) break;
    time_ = ida_->time();
    y_ = ida_->y();
    rate_ = ida_->rate();
    account(rates({time_, y_, rate_}), time_);
    stopped = write_until(time_);
    if (advance == numerics::IdaAdvance::reached_limit && linkage_->limit() >= options_.duration) break;
    const std::vector<int> found = ida_->events_found();
    const auto arms = static_cast<std::size_t>(linkage_->event_count());  // the last of the events
    bool changed = linkage_->follow({time_, ida_->y(), rate_}, std::span(found).last(arms), y_);
    if (linkage_->stuck()) {
      result_.report.termination = numerics::Termination::step_too_small;
      result_.report.message = *linkage_->stuck();
      break;
    }
    if (advance != numerics::IdaAdvance::event) {
      if (changed) settle();
      continue;
    }
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      if (found[k] >= 0) continue;  // only a falling gap or force is an event
      changed = true;
      if (contacts_[k].closed()) {
        contacts_[k].open(y_);
        result_.events.push_back({time_, static_cast<int>(k), MotionEvent::Kind::lift_off, 0.0});
      } else {
        close(static_cast<int>(k));
      }
    }
    for (std::size_t k = 0; k < springs_.size(); ++k) {
      const std::size_t event = contacts_.size() + k;
      if (found[event] == 0) continue;
      changed = true;
      const bool touch = found[event] > 0;
      result_.events.push_back({time_, static_cast<int>(event), touch ? MotionEvent::Kind::touch : MotionEvent::Kind::lift_off,
                                0.0});
    }
    if (changed) settle();
    if (static_cast<int>(result_.events.size()) > options_.max_events) {
      result_.report.termination = numerics::Termination::iteration_limit;
      result_.report.message =
          fmt::format("more than {} contact events by {:.9g} s", options_.max_events, time_);
      break;
    }
  }
  if (result_.report.usable()) result_.report = ida_->report();
  if (stopped && result_.report.usable()) {
    result_.report.termination = numerics::Termination::interrupted;
    result_.report.message = fmt::format("stopped by the observer at {:.9g} s", time_);
  }
  result_.report.time = time_;
  const MotionSample last = sample({time_, y_, rate_});
  result_.energy = last.energy;
  result_.momentum_error = last.momentum - start_momentum_ - outer_impulse_;
  result_.statistics = ida_->statistics();
  result_.last = {time_, y_, rate_};
  result_.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return result_;
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

MotionResult simulate(const Motion& motion, const MotionOptions& options, const MotionObserver& observer) {
  validate(motion, options);
  Run run(motion, options, observer);
  return run.go();
}

}  // namespace snare::coupling
