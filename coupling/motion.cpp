#include "coupling/motion.hpp"

#include "coupling/motion_body.hpp"
#include "coupling/motion_impulse.hpp"
#include "coupling/motion_points.hpp"
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
    c.require(k.points >= 1 && k.points <= 1000, k.name + ".points", k.points, "must be 1 to 1000");
    c.require(std::isfinite(k.wire_radius) && k.wire_radius >= 0.0, k.name + ".wire_radius", k.wire_radius, "must be >= 0");
    c.require(!k.shape || k.shape->smallest_radius() > 0.0 || k.wire_radius > 0.0, k.name + ".wire_radius", k.wire_radius,
              "must be > 0 for a shape with edges");
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

/// Powers and forces at one time, whose integrals along the run are kept.
struct Rates {
  double dissipated = 0.0;            // [W]
  double work = 0.0;                  // [W]
  Vector3d outer = Vector3d::Zero();  // sum of all outer forces on wires and free bodies [N]
  std::vector<Vector3d> contact;      // on the wires [N]
};

/// A point of a contact.
struct Closed {
  std::size_t contact = 0, point = 0;
  ContactPart* part = nullptr;
};

class Run {
 public:
  Run(const Motion& motion, const MotionOptions& options, const MotionObserver& observer);
  MotionResult go();

 private:
  [[nodiscard]] std::vector<numerics::DaePart*> parts();
  void require_apart();
  void make_rates();
  [[nodiscard]] std::vector<Closed> constraints();
  [[nodiscard]] Eigen::MatrixXd flexibility(const std::vector<Closed>& constraints) const;
  [[nodiscard]] std::optional<double> first_touch(double from, const numerics::Ida& ida);
  [[nodiscard]] bool close_touching();
  void open(const Closed& point);
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
  std::deque<ContactPoints> contacts_;
  std::deque<SpringPart> springs_;
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
  system_ = std::make_unique<numerics::DaeSystem>(parts());
  y_ = VectorXd::Zero(system_->size());
  rate_ = y_;
  for (std::size_t i = 0; i < rods_.size(); ++i)
    rods_[i].place(motion.wires[i].positions, motion.wires[i].velocities, y_);
  for (const BodyPart& b : bodies_) b.place(y_);
  require_apart();
  numerics::IdaOptions ida;
  ida.relative_tolerance = options.relative_tolerance;
  ida.max_order = options.max_order;
  ida.max_step = options.max_step;
  ida_ = std::make_unique<numerics::Ida>(*system_, ida);
  ida_->watch([this](double from, const numerics::Ida& now) { return first_touch(from, now); });
  result_.peak_force.assign(contacts_.size() + springs_.size(), 0.0);
  result_.impulse.assign(contacts_.size() + springs_.size(), Vector3d::Zero());
}

std::vector<numerics::DaePart*> Run::parts() {
  std::vector<numerics::DaePart*> list;
  for (auto& r : rods_) list.push_back(&r);
  for (auto& b : bodies_) list.push_back(&b);
  for (auto& c : contacts_) {
    for (auto& p : c.points()) list.push_back(&p);
  }
  for (auto& s : springs_) list.push_back(&s);
  return list;
}

// A wire that is inside a shape has no side to which it belongs.
void Run::require_apart() {
  std::vector<numerics::InputProblem> problems;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const MotionContact& c = motion_.contacts[k];
    const GapMinimum n = contacts_[k].nearest(y_);
    for (const ContactPart& p : contacts_[k].points()) y_[p.coordinate_unknown()] = n.coordinate;
    // The start may touch, up to a small part of the wire's radius.
    if (!c.law && n.gap < -0.01 * c.wire_radius - options_.position_tolerance)
      problems.push_back({"", 0, c.name + ".gap", fmt::format("{} at {} m along the wire", n.gap, n.coordinate), "must be >= 0 m at the start"});
  }
  if (!problems.empty()) throw numerics::InputError(problems);
}

std::vector<Closed> Run::constraints() {
  std::vector<Closed> list;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    for (std::size_t p = 0; p < contacts_[k].points().size(); ++p) {
      ContactPart& part = contacts_[k].points()[p];
      if (part.closed() && !part.has_law()) list.push_back({k, p, &part});
    }
  }
  return list;
}

// Normal speeds of all closed points by a unit impulse at each.
Eigen::MatrixXd Run::flexibility(const std::vector<Closed>& constraints) const {
  const auto n = static_cast<Eigen::Index>(constraints.size());
  Eigen::MatrixXd a(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    VectorXd unit = VectorXd::Zero(y_.size());
    constraints[static_cast<std::size_t>(i)].part->respond(y_, 1.0, unit);
    for (Eigen::Index j = 0; j < n; ++j) a(j, i) = constraints[static_cast<std::size_t>(j)].part->gap_rate_of(y_, unit);
  }
  return a;
}

void Run::open(const Closed& point) {
  contacts_[point.contact].open(point.point, y_);
  result_.events.push_back({time_, static_cast<int>(point.contact), static_cast<int>(point.point), y_[point.part->coordinate_unknown()],
                            MotionEvent::Kind::lift_off, 0.0});
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
  for (ContactPoints& c : contacts_) {
    for (ContactPart& p : c.points()) y_[p.force_unknown()] = 0.0;
  }
  VectorXd rows(system_->size());
  system_->residual({time_, y_, rate_}, rows);
  for (ContactPoints& c : contacts_) {
    for (ContactPart& p : c.points()) {
      if (p.closed() && p.has_law()) y_[p.force_unknown()] = -rows[p.force_unknown()];
    }
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
  // Points that would pull let go.
  const std::vector<Closed> all = constraints();
  if (all.empty()) return;
  VectorXd apart(static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    apart[static_cast<Eigen::Index>(i)] = all[i].part->gap_rate_of(y_, rate_) + all[i].part->gap_acceleration_at_rest(y_);
  }
  const VectorXd force = complementary_impulses(flexibility(all), apart, options_.force_tolerance);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double f = force[static_cast<Eigen::Index>(i)];
    y_[all[i].part->force_unknown()] = f;
    all[i].part->respond(y_, f, rate_);
  }
  const VectorXd left = flexibility(all) * force + apart;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (force[k] == 0.0 && left[k] > 0.0) open(all[i]);
  }
}

// The first touch of any contact within the integrator's last step.
std::optional<double> Run::first_touch(double from, const numerics::Ida& ida) {
  if (contacts_.empty()) return std::nullopt;
  const auto clock = std::chrono::steady_clock::now();
  ContactSearch::Step step{ida, from, ida.time(), {}};
  for (int k = 1; k <= ida.last_order(); ++k) step.derivatives.push_back(ida.interpolate(ida.time(), k));
  std::optional<double> first;
  for (ContactPoints& c : contacts_) {
    if (const auto touch = c.first_touch(step, first.value_or(step.to))) first = touch;
  }
  if (first) {
    for (ContactPoints& c : contacts_) c.forget();
  }
  result_.search_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return first;
}

// The wire's local masses take on the body's normal velocity at once (no restitution): the impulses that leave dg/dt >= 0 at all
// closed points and pull nowhere. What is lost vanishes with the element's mass.                    theory.md (M.10)
// False: a touch that cannot be taken, which the report names.
bool Run::close_touching() {
  const auto refuse = [this](const std::string& what) {
    result_.report.termination = numerics::Termination::iteration_limit;
    result_.report.message = fmt::format("{} at {:.9g} s", what, time_);
    return false;
  };
  struct Touch {
    Closed point;
    double approach = 0.0;
  };
  std::vector<Touch> touches;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    for (const GapMinimum& m : contacts_[k].touching(y_)) {
      const std::optional<std::size_t> free = contacts_[k].free_point();
      if (!free) {
        return refuse(fmt::format("{}: the wire touches at more than {} points (at {:.6g} m along it too)", motion_.contacts[k].name,
                                  contacts_[k].points().size(), m.coordinate));
      }
      ContactPart& part = contacts_[k].points()[*free];
      if (part.close(m.coordinate, y_)) system_->invalidate_pattern();
      touches.push_back({{k, *free, &part}, -part.gap_rate(y_)});
    }
  }
  const std::vector<Closed> all = constraints();
  if (!all.empty() && !touches.empty()) {
    const Eigen::MatrixXd a = flexibility(all);
    VectorXd apart(a.rows());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      apart[k] = all[i].part->gap_rate(y_);
      if (a(k, k) > 0.0) continue;
      return refuse(fmt::format("{} touches the wire where its mount holds it, and neither gives way", motion_.contacts[all[i].contact].name));
    }
    const VectorXd impulse = complementary_impulses(a, apart, 0.0);
    const VectorXd left = a * impulse + apart;
    const double before = stored({time_, y_, rate_}, nullptr).kinetic;
    for (std::size_t i = 0; i < all.size(); ++i) all[i].part->respond(y_, impulse[static_cast<Eigen::Index>(i)], y_);
    result_.energy.impacts += before - stored({time_, y_, rate_}, nullptr).kinetic;
    // What the impulses drive apart is open again; round-off of the speeds does not.
    constexpr double parting = 1e-9;  // [m/s]
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (impulse[k] > 0.0 || left[k] <= parting) continue;
      const auto own = std::find_if(touches.begin(), touches.end(), [&](const Touch& t) { return t.point.part == all[i].part; });
      if (own == touches.end()) {
        open(all[i]);
      } else {
        contacts_[all[i].contact].open(all[i].point, y_);
        touches.erase(own);
      }
    }
  }
  for (const Touch& t : touches) {
    result_.events.push_back({time_, static_cast<int>(t.point.contact), static_cast<int>(t.point.point),
                              y_[t.point.part->coordinate_unknown()], MotionEvent::Kind::touch, t.approach});
  }
  return true;
}

void Run::settle() {
  make_rates();
  ida_->start(time_, y_, rate_);
  for (ContactPoints& c : contacts_) c.forget();
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
    const ContactSample s = contacts_[k].closed_sample(at);
    const BodyPart& body = bodies_[static_cast<std::size_t>(motion_.contacts[k].body)];
    r.contact.push_back(s.force);
    for (const ContactPart& p : contacts_[k].points()) {
      r.dissipated += p.lost_power(at.y);
      const std::array<Vector3d, 2> held = p.force_on_mounts(at.y);
      r.outer -= held[0] + held[1];
    }
    if (!body.moves_freely()) {
      r.work += s.force.dot(at.y.segment<3>(body.velocity()));
      r.outer += s.force;
    }
    result_.peak_force[k] = std::max(result_.peak_force[k], s.normal_force);
    for (const ContactSample& p : s.points) {
      if (!motion_.contacts[k].law) result_.largest_penetration = std::max(result_.largest_penetration, -p.gap);
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
  e.dissipated = result_.energy.dissipated;
  e.impacts = result_.energy.impacts;
  e.work = result_.energy.work;
  e.integrator = e.kinetic + e.strain + e.potential + e.dissipated + e.impacts - e.work - start_energy_;
  s.energy = e;
  for (const BodyPart& b : bodies_) s.bodies.push_back(b.state(at.y));
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    s.contacts.push_back(contacts_[k].sample(at));
    const auto w = static_cast<std::size_t>(motion_.contacts[k].wire);
    for (const ContactPart& p : contacts_[k].points()) {
      const std::array<Vector3d, 2> held = p.force_on_mounts(at.y);
      s.mount_forces[2 * w] -= held[0];
      s.mount_forces[2 * w + 1] -= held[1];
    }
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
  bool stopped = !close_touching();
  settle();
  stopped = write_until(0.0) || stopped;
  while (!stopped) {
    const numerics::IdaAdvance advance = ida_->advance(options_.duration);
    if (advance == numerics::IdaAdvance::failed) break;
    time_ = ida_->time();
    y_ = ida_->y();
    rate_ = ida_->rate();
    account(rates({time_, y_, rate_}), time_);
    stopped = write_until(time_);
    if (advance == numerics::IdaAdvance::reached_limit) break;
    if (advance != numerics::IdaAdvance::event) continue;
    const std::vector<int> found = ida_->events_found();
    // The watch stops a step at a touch, without an event of the integrator.
    bool changed = std::none_of(found.begin(), found.end(), [](int f) { return f != 0; });
    if (changed && !close_touching()) break;
    std::size_t event = 0;
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      for (std::size_t p = 0; p < contacts_[k].points().size(); ++p, ++event) {
        if (found[event] >= 0) continue;  // only a falling force is an event
        changed = true;
        open({k, p, &contacts_[k].points()[p]});
      }
    }
    for (std::size_t k = 0; k < springs_.size(); ++k, ++event) {
      if (found[event] == 0) continue;
      changed = true;
      const bool touch = found[event] > 0;
      result_.events.push_back({time_, static_cast<int>(contacts_.size() + k), 0, 0.0,
                                touch ? MotionEvent::Kind::touch : MotionEvent::Kind::lift_off, 0.0});
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
