// What happens at the events of a motion: touch, lift-off, stick and slip, and the start after them.

#include "coupling/contact/complementarity.hpp"
#include "coupling/dynamics/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;

std::vector<ContactHandle> MotionRun::points() {
  std::vector<ContactHandle> list;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    for (std::size_t p = 0; p < contacts_[k].points().size(); ++p) list.push_back({k, p, &contacts_[k].points()[p]});
  }
  return list;
}

std::vector<ContactHandle> MotionRun::constraints() {
  std::vector<ContactHandle> list = points();
  std::erase_if(list, [](const ContactHandle& p) { return !p.part->closed() || p.part->has_law(); });
  return list;
}

// Normal speeds of all closed points by a unit impulse at each, with the constraints held.
Eigen::MatrixXd MotionRun::flexibility(const std::vector<ContactHandle>& constraints, bool with_friction) const {
  const auto n = static_cast<Eigen::Index>(constraints.size());
  Eigen::MatrixXd a(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ContactPart& part = *constraints[static_cast<std::size_t>(i)].part;
    VectorXd unit = VectorXd::Zero(y_.size());
    if (with_friction) {
      part.respond_with_friction(y_, 1.0, unit);
    } else {
      part.apply_impulse(y_, 1.0, unit);
    }
    constraints_->project(y_, unit);
    for (Eigen::Index j = 0; j < n; ++j) a(j, i) = constraints[static_cast<std::size_t>(j)].part->gap_rate_of(y_, unit);
  }
  return a;
}

void MotionRun::note(const ContactHandle& point, MotionEvent::Kind kind, double speed) {
  sums_.events.push_back({time_, static_cast<int>(point.contact), static_cast<int>(point.point),
                          y_[point.part->coordinate_unknown()], kind, speed});
}

void MotionRun::open(const ContactHandle& point) {
  integrals_[integral::dissipated] += contacts_[point.contact].open(point.point, y_);
  note(point, MotionEvent::Kind::lift_off, 0.0);
}

// With all accelerations and constraint forces zero the rows are minus the forces; what the constraints then miss in
// d2g/dt2 = 0 gives their forces.                                                              theory.md (M.10)
void MotionRun::make_rates() {
  rate_.setZero();
  for (const wire::RodPart& r : rods_) {
    for (int i = 0; i < r.vertices(); ++i) rate_.segment<3>(r.position_of(i)) = y_.segment<3>(r.velocity_of(i));
  }
  for (const BodyPart& b : bodies_) {
    rate_.segment<3>(b.position()) = y_.segment<3>(b.velocity());
    rate_.segment<4>(b.quaternion()) =
        multibody::quaternion_rates(y_.segment<4>(b.quaternion())) * y_.segment<3>(b.spin());
  }
  for (const ContactHandle& p : points()) y_[p.part->force_unknown()] = 0.0;
  constraints_->loosen(y_);
  VectorXd rows(system_->size());
  system_->residual({time_, y_, rate_}, rows);
  for (const ContactHandle& p : points()) {
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
  constraints_->solve_rates(y_, rows, rate_);
  VectorXd held_rate = rate_;
  static_cast<void>(constraints_->hold_rates(y_, held_rate));
  const std::vector<ContactHandle> all = constraints();
  VectorXd apart(static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    apart[static_cast<Eigen::Index>(i)] =
        all[i].part->gap_rate_of(y_, held_rate) + all[i].part->gap_acceleration_at_rest(y_);
  }
  const Eigen::MatrixXd a = flexibility(all, true);
  const VectorXd force = all.empty()
                             ? VectorXd()
                             : complementary_impulses(a, apart, VectorXd::Constant(a.rows(), options_.force_tolerance));
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
  constraints_->set_multipliers(constraints_->hold_rates(y_, rate_), y_);
  for (const ContactHandle& p : points()) p.part->set_bristle_rate(y_, rate_);
}

// The first touch of any contact within the integrator's last step.
std::optional<double> MotionRun::first_touch(double from, const numerics::Ida& ida) {
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

// Impulses by which closed points may pull when another one touches: what would part at a speed far below the tolerance, or would be pressed
// together again before a wave has crossed an element, would only come back at once and set off its neighbours.
VectorXd MotionRun::allowed_tension(const std::vector<ContactHandle>& constraints, const VectorXd& flexibility) const {
  const double parting = std::max(1e-9, 0.1 * options_.velocity_tolerance);  // [m/s]
  VectorXd pulls = parting * flexibility.cwiseInverse();
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const wire::RodInMotion& rod =
        rods_[static_cast<std::size_t>(motion_.contacts[constraints[i].contact].wire)].constants();
    const double crossing = rod.length / rod.elements * std::sqrt(rod.mass_per_length / rod.properties.axial_stiffness);
    double& pull = pulls[static_cast<Eigen::Index>(i)];
    pull = std::max(pull, 0.5 * crossing * y_[constraints[i].part->force_unknown()]);
  }
  return pulls;
}

// The wire's local masses take on the body's normal velocity at once (no restitution): the impulses that leave dg/dt >= 0 at all
// closed points and pull nowhere. What is lost vanishes with the element's mass.                    theory.md (M.10)
// A touch that cannot be taken is returned in words.
std::optional<std::string> MotionRun::close_touching() {
  struct Touch {
    ContactHandle point;
    double approach = 0.0;
    double gap = 0.0;
  };
  std::vector<Touch> touches;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    for (const GapMinimum& m : contacts_[k].touching(y_)) {
      const std::optional<std::size_t> free = contacts_[k].free_point();
      if (!free) {
        return fmt::format(
            "{}: the wire touches at more than {} points (at {:.6g} m along it too) at {:.9g} s; allow more",
            motion_.contacts[k].name, contacts_[k].points().size(), m.coordinate, time_);
      }
      ContactPart& part = contacts_[k].points()[*free];
      if (part.close(m.coordinate, y_)) system_->invalidate_pattern();
      touches.push_back({{k, *free, &part}, -part.gap_rate(y_), m.gap});
    }
  }
  const std::vector<ContactHandle> all = constraints();
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
    const VectorXd impulse = complementary_impulses(a, apart, allowed_tension(all, a.diagonal()));
    const VectorXd left = a * impulse + apart;
    const double before = stored({time_, y_, rate_}, nullptr).kinetic;
    const double worked = integrals_[integral::work];
    VectorXd change = VectorXd::Zero(y_.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double p = impulse[static_cast<Eigen::Index>(i)];
      const Vector3d along = p * all[i].part->normal(y_);
      integrals_.segment<3>(integral::contacts + 3 * static_cast<Eigen::Index>(all[i].contact)) += along;
      add_reactions(all[i], along, {time_, y_, rate_}, integrals_);
      all[i].part->apply_impulse(y_, p, change);
    }
    constraints_->project(y_, change);
    y_ += change;
    sums_.impacts += before + integrals_[integral::work] - worked - stored({time_, y_, rate_}, nullptr).kinetic;
    // What the impulses drive apart is open again; round-off of the speeds does not.
    constexpr double round_off = 1e-9;  // [m/s]
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (impulse[k] != 0.0 || left[k] <= round_off) continue;
      const auto own =
          std::find_if(touches.begin(), touches.end(), [&](const Touch& t) { return t.point.part == all[i].part; });
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

void MotionRun::switch_friction(const ContactHandle& point) {
  ContactPart& c = *point.part;
  const bool slips = c.friction_mode() == FrictionMode::stick;
  c.set_friction_mode(slips ? FrictionMode::slip : FrictionMode::stick);
  note(point, slips ? MotionEvent::Kind::slip : MotionEvent::Kind::stick, c.sliding_speed(y_));
}

// Stick and slip that have ended: found as events, or left behind by a start that no mode fitted.
bool MotionRun::leave_broken_modes(bool at_event) {
  bool changed = false;
  const std::vector<ContactHandle> all = points();
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

// A minimum of the gap may be lost within a step, beyond the end of a rounded edge even at once, and no step, however small, finds it (G.9).
// Its point rests on the wire from the last state on. False where there is none, or that was tried often without getting on.
bool MotionRun::rest_lost_minima() {
  constexpr double same_time = 1e-9;  // [s]
  constexpr int most_trials = 10;
  if (time_ > rested_ + same_time) trials_ = 0;
  rested_ = time_;
  if (++trials_ > most_trials) return false;
  bool changed = false;
  for (const ContactHandle& p : points()) {
    if (!p.part->closed()) continue;
    p.part->rest_on_wire();
    changed = true;
  }
  return changed;
}

void MotionRun::settle() {
  make_rates();
  // Friction that starts outside of its mode changes it; a change may move the normal forces, so that it is asked again.
  constexpr int most_changes = 4;
  for (int change = 0; change < most_changes && leave_broken_modes(false); ++change) make_rates();
  ida_->set_integrals(integrals_);
  ida_->start(time_, y_, rate_);
  for (ContactPoints& c : contacts_) c.forget();
}

}  // namespace snare::coupling
