#include "coupling/motion.hpp"

#include "coupling/motion_body.hpp"
#include "coupling/motion_check.hpp"
#include "coupling/motion_contact.hpp"
#include "coupling/motion_impulse.hpp"
#include "coupling/motion_linkage.hpp"
#include "coupling/motion_points.hpp"
#include "coupling/motion_spring.hpp"
#include "numerics/errors.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <optional>
#include <span>
#include <utility>

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;
using numerics::DaePoint;

namespace {

/// Where the integrals along the run stand: powers [W], sums of all outer forces [N] and moments about the origin [N m] on
/// wires and free bodies, and the force of every contact on its wire and of every body on its spring [N].
namespace integral {
constexpr Eigen::Index dissipated = 0;
constexpr Eigen::Index work = 1;
constexpr Eigen::Index outer = 2;
constexpr Eigen::Index outer_moment = 5;
constexpr Eigen::Index contacts = 8;
}  // namespace integral

/// Times that differ by less are the same: the integrator cannot step from one to the other.
bool reached(double time, double limit) {
  constexpr double round_off = 1e-13;
  return time >= limit - round_off * std::max(1.0, limit);
}

/// A point of a contact.
struct Closed {
  std::size_t contact = 0, point = 0;
  ContactPart* part = nullptr;
};

class Run {
 public:
  Run(const Motion& motion, const MotionOptions& options, const MotionObserver& observer);
  void begin();
  void resume(const MotionState& from);
  /// Goes on to `limit` [s].
  MotionResult go(double limit);

 private:
  [[nodiscard]] std::vector<numerics::DaePart*> parts();
  void require_apart();
  void make_rates();
  [[nodiscard]] std::vector<Closed> points();
  [[nodiscard]] std::vector<Closed> constraints();
  [[nodiscard]] Eigen::MatrixXd flexibility(const std::vector<Closed>& constraints, bool with_friction) const;
  [[nodiscard]] std::optional<double> first_touch(double from, const numerics::Ida& ida);
  [[nodiscard]] std::optional<std::string> close_touching();
  void note(const Closed& point, MotionEvent::Kind kind, double speed);
  void open(const Closed& point);
  void settle();
  void switch_friction(const Closed& point);
  [[nodiscard]] bool rest_lost_minima();
  [[nodiscard]] bool leave_broken_modes(bool at_event);
  [[nodiscard]] MotionSample sample(const DaePoint& at, const VectorXd& integrals);
  [[nodiscard]] EnergyBalance stored(const DaePoint& at, MotionSample* into);
  void integrands(const DaePoint& at, Eigen::Ref<VectorXd> rates);
  void watch();
  void add_reactions(const Closed& point, const Vector3d& force, const DaePoint& at, Eigen::Ref<VectorXd> rates) const;
  [[nodiscard]] bool write_until(double time);
  [[nodiscard]] MotionResult result(numerics::IdaReport report);

  const Motion& motion_;
  MotionOptions options_;
  const MotionObserver& observer_;
  std::deque<wire::RodPart> rods_;
  std::deque<BodyPart> bodies_;
  std::deque<ContactPoints> contacts_;
  std::deque<SpringPart> springs_;
  std::deque<FrictionEvent> friction_events_;  // behind all other events
  std::optional<Linkage> linkage_;
  std::unique_ptr<numerics::DaeSystem> system_;
  std::unique_ptr<numerics::Ida> ida_;
  VectorXd y_, rate_;
  VectorXd integrals_;
  double time_ = 0.0;
  double rested_ = -std::numeric_limits<double>::infinity();  // when points were last made to rest on the wire [s]
  int trials_ = 0;                                            // of that, one soon after the other
  MotionSums sums_;
  std::optional<std::string> refused_;  // a touch that cannot be taken
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
  for (const Closed& p : points()) friction_events_.emplace_back(*p.part);
  linkage_.emplace(motion, rods_, bodies_, options);
  system_ = std::make_unique<numerics::DaeSystem>(parts());
  y_ = VectorXd::Zero(system_->size());
  rate_ = y_;
  for (std::size_t i = 0; i < rods_.size(); ++i)
    rods_[i].place(motion.wires[i].positions, motion.wires[i].velocities, y_);
  for (const BodyPart& b : bodies_) b.place(y_);
  linkage_->place(y_);
  require_apart();
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
  ida_->watch([this](double from, const numerics::Ida& now) { return first_touch(from, now); });
  sums_.peak_force.assign(static_cast<std::size_t>(touching), 0.0);
}

std::vector<numerics::DaePart*> Run::parts() {
  std::vector<numerics::DaePart*> list;
  for (auto& r : rods_) list.push_back(&r);
  for (auto& b : bodies_) list.push_back(&b);
  for (const Closed& p : points()) list.push_back(p.part);
  for (auto& s : springs_) list.push_back(&s);
  for (auto& f : friction_events_) list.push_back(&f);
  linkage_->append(list);
  return list;
}

// A wire that is inside a shape has no side to which it belongs.
void Run::require_apart() {
  std::vector<numerics::InputProblem> problems;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const MotionContact& c = motion_.contacts[k];
    const GapMinimum n = contacts_[k].nearest(y_);
    for (ContactPart& p : contacts_[k].points()) p.wait_at(n.coordinate, y_);
    // The start may touch, up to a small part of the wire's radius.
    if (!c.law && n.gap < -0.01 * c.wire_radius - options_.position_tolerance)
      problems.push_back({"", 0, c.name + ".gap", fmt::format("{} at {} m along the wire", n.gap, n.coordinate), "must be >= 0 m at the start"});
  }
  if (!problems.empty()) throw numerics::InputError(problems);
}

std::vector<Closed> Run::points() {
  std::vector<Closed> list;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    for (std::size_t p = 0; p < contacts_[k].points().size(); ++p) list.push_back({k, p, &contacts_[k].points()[p]});
  }
  return list;
}

std::vector<Closed> Run::constraints() {
  std::vector<Closed> list = points();
  std::erase_if(list, [](const Closed& p) { return !p.part->closed() || p.part->has_law(); });
  return list;
}

// Normal speeds of all closed points by a unit impulse at each, with the links held.
Eigen::MatrixXd Run::flexibility(const std::vector<Closed>& constraints, bool with_friction) const {
  const auto n = static_cast<Eigen::Index>(constraints.size());
  Eigen::MatrixXd a(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ContactPart& part = *constraints[static_cast<std::size_t>(i)].part;
    VectorXd unit = VectorXd::Zero(y_.size());
    if (with_friction) {
      part.respond_with_friction(y_, 1.0, unit);
    } else {
      part.respond(y_, 1.0, unit);
    }
    linkage_->hold(y_, unit);
    for (Eigen::Index j = 0; j < n; ++j) a(j, i) = constraints[static_cast<std::size_t>(j)].part->gap_rate_of(y_, unit);
  }
  return a;
}

void Run::note(const Closed& point, MotionEvent::Kind kind, double speed) {
  sums_.events.push_back({time_, static_cast<int>(point.contact), static_cast<int>(point.point),
                          y_[point.part->coordinate_unknown()], kind, speed});
}

void Run::open(const Closed& point) {
  integrals_[integral::dissipated] += contacts_[point.contact].open(point.point, y_);
  note(point, MotionEvent::Kind::lift_off, 0.0);
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
  for (const Closed& p : points()) y_[p.part->force_unknown()] = 0.0;
  linkage_->loosen(y_);
  VectorXd rows(system_->size());
  system_->residual({time_, y_, rate_}, rows);
  for (const Closed& p : points()) {
    if (p.part->closed() && p.part->has_law()) y_[p.part->force_unknown()] = -rows[p.part->force_unknown()];
  }
  system_->residual({time_, y_, rate_}, rows);
  for (const wire::RodPart& r : rods_) {
    for (int i = 0; i < r.vertices(); ++i) {
      for (int k = 0; k < 3; ++k) {
        if (!r.is_held(i, k)) rate_[r.velocity_of(i) + k] = -rows[r.velocity_of(i) + k] / r.mass_of(i);
      }
      if (r.constants().strands.act()) rate_.segment<2>(r.strand_of(i)) = -rows.segment<2>(r.strand_of(i));
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
  linkage_->solve_rates(y_, rows, rate_);
  VectorXd held_rate = rate_;
  static_cast<void>(linkage_->hold_rates(y_, held_rate));
  const std::vector<Closed> all = constraints();
  VectorXd apart(static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    apart[static_cast<Eigen::Index>(i)] =
        all[i].part->gap_rate_of(y_, held_rate) + all[i].part->gap_acceleration_at_rest(y_);
  }
  const Eigen::MatrixXd a = flexibility(all, true);
  const VectorXd force = all.empty() ? VectorXd() : complementary_impulses(a, apart, VectorXd::Constant(a.rows(), options_.force_tolerance));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double f = force[static_cast<Eigen::Index>(i)];
    all[i].part->begin_force(f, y_);
    all[i].part->respond_with_friction(y_, f, rate_);
  }
  // Points that would pull let go.
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (force[k] == 0.0 && a.row(k).dot(force) + apart[k] > 0.0) open(all[i]);
  }
  linkage_->set_multipliers(linkage_->hold_rates(y_, rate_), y_);
  for (const Closed& p : points()) p.part->set_bristle_rate(y_, rate_);
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
  sums_.search_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return first;
}

// The wire's local masses take on the body's normal velocity at once (no restitution): the impulses that leave dg/dt >= 0 at all
// closed points and pull nowhere. What is lost vanishes with the element's mass.                    theory.md (M.10)
// A touch that cannot be taken is returned in words.
std::optional<std::string> Run::close_touching() {
  struct Touch {
    Closed point;
    double approach = 0.0;
    double gap = 0.0;
  };
  std::vector<Touch> touches;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    for (const GapMinimum& m : contacts_[k].touching(y_)) {
      const std::optional<std::size_t> free = contacts_[k].free_point();
      if (!free) {
        return fmt::format("{}: the wire touches at more than {} points (at {:.6g} m along it too) at {:.9g} s; allow more",
                           motion_.contacts[k].name, contacts_[k].points().size(), m.coordinate, time_);
      }
      ContactPart& part = contacts_[k].points()[*free];
      if (part.close(m.coordinate, y_)) system_->invalidate_pattern();
      touches.push_back({{k, *free, &part}, -part.gap_rate(y_), m.gap});
    }
  }
  const std::vector<Closed> all = constraints();
  if (!all.empty() && !touches.empty()) {
    const Eigen::MatrixXd a = flexibility(all, false);
    VectorXd apart(a.rows());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      apart[k] = all[i].part->gap_rate(y_);
      if (a(k, k) > 0.0) continue;
      return fmt::format("{} touches the wire where its mount holds it, and neither gives way, at {:.9g} s",
                         motion_.contacts[all[i].contact].name, time_);
    }
    // What would part at a speed far below the tolerance stays closed: it would come back at once, and set off its neighbours.
    const double parting = std::max(1e-9, 0.1 * options_.velocity_tolerance);  // [m/s]
    const VectorXd impulse = complementary_impulses(a, apart, parting * a.diagonal().cwiseInverse());
    const VectorXd left = a * impulse + apart;
    const double before = stored({time_, y_, rate_}, nullptr).kinetic;
    const double worked = integrals_[integral::work];
    VectorXd change = VectorXd::Zero(y_.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double p = impulse[static_cast<Eigen::Index>(i)];
      const Vector3d along = p * all[i].part->normal(y_);
      integrals_.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(all[i].contact)) += along;
      add_reactions(all[i], along, {time_, y_, rate_}, integrals_);
      all[i].part->respond(y_, p, change);
    }
    linkage_->hold(y_, change);
    y_ += change;
    sums_.impacts += before + integrals_[integral::work] - worked - stored({time_, y_, rate_}, nullptr).kinetic;
    // What the impulses drive apart is open again; round-off of the speeds does not.
    constexpr double round_off = 1e-9;  // [m/s]
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (impulse[k] != 0.0 || left[k] <= round_off) continue;
      const auto own = std::find_if(touches.begin(), touches.end(), [&](const Touch& t) { return t.point.part == all[i].part; });
      if (own == touches.end()) {
        open(all[i]);
      } else {
        integrals_[integral::dissipated] += contacts_[all[i].contact].open(all[i].point, y_);
        contacts_[all[i].contact].leave_apart(own->gap);
        touches.erase(own);
      }
    }
  }
  for (const Touch& t : touches) note(t.point, MotionEvent::Kind::touch, t.approach);
  return std::nullopt;
}

void Run::switch_friction(const Closed& point) {
  ContactPart& c = *point.part;
  const bool slips = c.friction_mode() == FrictionMode::stick;
  c.set_friction_mode(slips ? FrictionMode::slip : FrictionMode::stick);
  note(point, slips ? MotionEvent::Kind::slip : MotionEvent::Kind::stick, c.sliding_speed(y_));
}

// Stick and slip that have ended: found as events, or left behind by a start that no mode fitted.
bool Run::leave_broken_modes(bool at_event) {
  bool changed = false;
  const std::vector<Closed> all = points();
  // Behind the events of points and springs, before those of the arms.
  const std::size_t first = all.size() + springs_.size();
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!all[k].part->closed() || !all[k].part->has_bristle()) continue;
    const bool ended = at_event && ida_->events_found()[first + k] < 0;
    if (!ended && all[k].part->friction_margin(y_) >= 0.0) continue;
    switch_friction(all[k]);
    changed = true;
  }
  return changed;
}

// Beyond the end of a rounded edge a minimum of the gap may be lost at once, and no step, however small, finds it (G.9). Its point rests on
// the wire from the last state on. False where there is none, or that was tried often without getting on.
bool Run::rest_lost_minima() {
  constexpr double same_time = 1e-9;  // [s]
  constexpr int most_trials = 10;
  if (time_ > rested_ + same_time) trials_ = 0;
  rested_ = time_;
  if (++trials_ > most_trials) return false;
  bool changed = false;
  for (const Closed& p : points()) {
    const bool edges = motion_.contacts[p.contact].shape->smallest_radius() == 0.0;
    if (!edges || !p.part->closed()) continue;
    p.part->rest_on_wire();
    changed = true;
  }
  return changed;
}

void Run::settle() {
  make_rates();
  // Friction that starts outside of its mode changes it; a change may move the normal forces, so that it is asked again.
  constexpr int most_changes = 4;
  for (int change = 0; change < most_changes && leave_broken_modes(false); ++change) make_rates();
  ida_->set_integrals(integrals_);
  ida_->start(time_, y_, rate_);
  for (ContactPoints& c : contacts_) c.forget();
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
  for (const Closed& p : points()) e.strain += p.part->bristle_energy(at.y);
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

// Of a contact's force (or impulse) on its wire: what a driven body gives, with its work, and what goes on to rigidly
// held components, where it is no part of the rod's own reaction.
void Run::add_reactions(const Closed& contact, const Vector3d& force, const DaePoint& at,
                        Eigen::Ref<VectorXd> rates) const {
  const ContactPart& c = *contact.part;
  const wire::RodPart& rod = rods_[static_cast<std::size_t>(motion_.contacts[contact.contact].wire)];
  const BodyPart& body = bodies_[static_cast<std::size_t>(motion_.contacts[contact.contact].body)];
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
  for (const Closed& p : points()) {
    if (!p.part->closed()) continue;
    const Vector3d force = p.part->sample(at).force;
    rates.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(p.contact)) += force;
    rates[integral::dissipated] += p.part->lost_power(at.y);
    add_reactions(p, force, at, rates);
  }
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const ContactSample s = springs_[k].sample(at);
    rates.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(contacts_.size() + k)) = s.force;
    rates[integral::dissipated] += springs_[k].taken_power(at);
    rates[integral::work] -= s.normal_force * motion_.springs[k].origin_speed;
    rates.segment<3>(integral::outer) -= s.force;
    rates.segment<3>(integral::outer_moment) -= s.point.cross(s.force);
  }
  const Linkage::Outer linked = linkage_->outer(at);
  rates.segment<3>(integral::outer) += linked.force;
  rates.segment<3>(integral::outer_moment) += linked.moment;
  rates[integral::work] += linked.power;
}

// Extremes over the accepted steps.
void Run::watch() {
  const DaePoint at{time_, y_, rate_};
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const ContactSample sum = contacts_[k].closed_sample(at);
    sums_.peak_force[k] = std::max(sums_.peak_force[k], sum.normal_force);
    if (motion_.contacts[k].law) continue;
    for (const ContactSample& s : sum.points) {
      sums_.largest_penetration = std::max(sums_.largest_penetration, -s.gap);
      sums_.largest_gap = std::max(sums_.largest_gap, std::abs(s.gap));
    }
  }
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    double& peak = sums_.peak_force[contacts_.size() + k];
    peak = std::max(peak, springs_[k].sample(at).normal_force);
  }
  sums_.largest_drift = std::max(sums_.largest_drift, linkage_->largest_gap(y_));
  for (const BodyPart& b : bodies_) {
    sums_.largest_drift = std::max(sums_.largest_drift, std::abs(y_.segment<4>(b.quaternion()).norm() - 1.0));
  }
  for (const wire::RodPart& r : rods_) sums_.largest_drift = std::max(sums_.largest_drift, r.mount_error(y_));
}

MotionSample Run::sample(const DaePoint& at, const VectorXd& integrals) {
  MotionSample s;
  s.time = at.time;
  EnergyBalance e = stored(at, &s);
  e.dissipated += integrals[integral::dissipated];
  e.impacts = sums_.impacts;
  e.work += integrals[integral::work];
  e.integrator = e.kinetic + e.strain + e.potential + e.dissipated + e.impacts - e.work - sums_.start_energy;
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
  for (const SpringPart& spring : springs_) s.contacts.push_back(spring.sample(at));
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
  refused_ = close_touching();
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
  std::span<const double> memory = from.memory;
  for (ContactPoints& c : contacts_) c.recall(memory);
  linkage_->recall(time_, y_, memory);
  system_->recall(y_, memory);
  ida_->set_integrals(integrals_);
  ida_->start(time_, y_, rate_);
}

MotionResult Run::go(double limit) {
  const auto clock = std::chrono::steady_clock::now();
  numerics::IdaReport report;
  bool stopped = write_until(time_);
  while (!stopped && !refused_ && !reached(time_, limit)) {
    const numerics::IdaAdvance advance = ida_->advance(std::min(limit, linkage_->limit()));
    report = ida_->report();
    if (advance == numerics::IdaAdvance::failed) {
      if (!rest_lost_minima()) break;
      settle();
      continue;
    }
    time_ = ida_->time();
    y_ = ida_->y();
    rate_ = ida_->rate();
    integrals_ = ida_->integrals();
    watch();
    stopped = write_until(time_) || (options_.stop && options_.stop());
    bool changed = leave_broken_modes(advance == numerics::IdaAdvance::event);
    const std::vector<int> found = ida_->events_found();
    const auto arms = static_cast<std::size_t>(linkage_->event_count());  // the last of the events
    changed = linkage_->follow({time_, ida_->y(), rate_}, std::span(found).last(arms), y_) || changed;
    if (linkage_->stuck()) {
      report.termination = numerics::Termination::step_too_small;
      report.message = *linkage_->stuck();
      break;
    }
    if (advance != numerics::IdaAdvance::event) {
      if (changed) settle();
      continue;
    }
    // The watch stops a step at a touch, without an event of the integrator.
    if (std::none_of(found.begin(), found.end(), [](int f) { return f != 0; })) {
      refused_ = close_touching();
      if (refused_) break;
      changed = true;
    }
    std::size_t event = 0;
    for (const Closed& p : points()) {
      if (found[event++] >= 0) continue;  // only a falling force is an event
      changed = true;
      open(p);
    }
    for (std::size_t k = 0; k < springs_.size(); ++k, ++event) {
      if (found[event] == 0) continue;
      changed = true;
      const bool touch = found[event] > 0;
      sums_.events.push_back({time_, static_cast<int>(contacts_.size() + k), 0, 0.0,
                              touch ? MotionEvent::Kind::touch : MotionEvent::Kind::lift_off, 0.0});
    }
    if (changed) settle();
    if (static_cast<int>(sums_.events.size()) > options_.max_events) {
      report.termination = numerics::Termination::iteration_limit;
      report.message = fmt::format("more than {} contact events by {:.9g} s", options_.max_events, time_);
      break;
    }
  }
  if (refused_) {
    report.termination = numerics::Termination::iteration_limit;
    report.message = *refused_;
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
  r.search_seconds = sums_.search_seconds;
  std::vector<double> memory;
  for (const ContactPoints& c : contacts_) c.remember(memory);
  linkage_->remember(memory);
  const std::vector<double> parts = system_->memory();
  memory.insert(memory.end(), parts.begin(), parts.end());
  r.last = {time_, y_, rate_, integrals_, std::move(memory), sums_};
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

std::string to_string(MotionEvent::Kind kind) {
  switch (kind) {
    case MotionEvent::Kind::touch: return "touch";
    case MotionEvent::Kind::lift_off: return "lift_off";
    case MotionEvent::Kind::stick: return "stick";
    case MotionEvent::Kind::slip: return "slip";
  }
  return "";
}

MotionResult simulate(const Motion& motion, const MotionOptions& options, const MotionObserver& observer,
                      const MotionState* from, const MotionKeeper& keeper) {
  require_valid(motion, options);
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
    if (!result.report.usable() || !reached(result.report.time, stop) || stop >= options.duration) return result;
    state = std::move(result.last);
    if (keeper) keeper(*state);
  }
}

}  // namespace snare::coupling
