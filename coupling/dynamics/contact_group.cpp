#include "coupling/dynamics/contact_group.hpp"

#include "coupling/contact/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace snare::coupling {

using numerics::VectorView;

ContactGroup::ContactGroup(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body) : rod_(rod) {
  const auto shapes = pieces_of(contact.shape, contact.wire_radius);
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    MotionContact one = contact;
    if (shapes.size() > 1) one.name = fmt::format("{} piece {}", contact.name, k + 1);
    pieces_.emplace_back(one, shapes[k], rod, body);
  }
}

ContactPart::Sums ContactGroup::sums(const VectorView& y) const {
  ContactPart::Sums all;
  for (const ContactPart& p : pieces_) {
    const ContactPart::Sums s = p.sums(y);
    all.force += s.force;
    all.moment += s.moment;
    all.normal += s.normal;
    all.lost_power += s.lost_power;
    all.energy += s.energy;
    all.body_power += s.body_power;
    for (std::size_t k = 0; k < 2; ++k) all.on_mounts[k] += s.on_mounts[k];
  }
  return all;
}

double ContactGroup::longest_step() const {
  double step = std::numeric_limits<double>::infinity();
  for (const ContactPart& p : pieces_) step = std::min(step, p.search().longest_step());
  return step;
}

NearestPoint ContactGroup::nearest(const VectorView& y) const {
  NearestPoint best{0.0, std::numeric_limits<double>::infinity()};
  for (const ContactPart& p : pieces_) {
    const NearestPoint n = p.search().nearest(y);
    if (n.gap < best.gap) best = n;
  }
  return best;
}

ContactSample ContactGroup::closed_sample(const VectorView& y) const {
  ContactSample sum;
  for (const ContactPart& p : pieces_) {
    for (const ContactSample& s : p.samples(y)) {
      if (!sum.closed || s.normal_force > sum.points[0].normal_force) {
        sum.gap = s.gap;
        sum.point = s.point;
        sum.arc = s.arc;
        sum.slip_speed = s.slip_speed;
        sum.sticking = s.sticking;
        sum.points.insert(sum.points.begin(), s);
      } else {
        sum.points.push_back(s);
      }
      sum.closed = true;
      sum.force += s.force;
      sum.normal_force += s.normal_force;
    }
  }
  return sum;
}

ContactSample ContactGroup::sample(const VectorView& y) const {
  ContactSample s = closed_sample(y);
  if (s.closed) return s;
  const NearestPoint n = nearest(y);
  s.gap = n.gap;
  s.arc = n.coordinate;
  const CurveWeights w = curve_weights(rod_, n.coordinate);
  for (int k = 0; k < 4; ++k) s.point += w.value[k] * y.segment<3>(rod_.position_of(w.first + k));
  return s;
}

ContactSample ContactGroup::sample(const VectorView& y, const Eigen::Vector3d& force, double normal) const {
  ContactSample s = sample(y);
  if (!s.closed && held_states_ < 2) return s;
  if (!s.closed) s.points.push_back(s);
  const double share = 1.0 / static_cast<double>(s.points.size());
  for (ContactSample& p : s.points) {
    const double part = s.normal_force > 0.0 ? p.normal_force / s.normal_force : share;
    p.closed = true;
    p.normal_force = part * std::max(normal, 0.0);
    p.force = part * force;
  }
  s.closed = true;
  s.normal_force = std::max(normal, 0.0);
  s.force = force;
  return s;
}

int ContactGroup::free_point() const {
  int point = 0;
  while (std::any_of(touching_.begin(), touching_.end(), [point](const Touching& t) { return t.point == point; }))
    ++point;
  return point;
}

std::pair<double, double> ContactGroup::gap_at(const VectorView& y, double coordinate) const {
  std::pair<double, double> nearest{std::numeric_limits<double>::infinity(), 0.0};
  for (const ContactPart& p : pieces_) nearest = std::min(nearest, p.gap_at(y, coordinate));
  return nearest;
}

// Stretches are the same when they have moved by no more than an element.
std::vector<MotionEvent> ContactGroup::observe(double time, const ContactSample& sample, const VectorView& y,
                                               double time_before, const VectorView& before) {
  std::vector<MotionEvent> events;
  std::vector<Touching> old = std::exchange(touching_, {});
  std::vector<const ContactSample*> fresh;
  const double reach = pieces_.front().search().curve().longest();
  for (const ContactSample& s : sample.points) {
    const auto same = std::min_element(old.begin(), old.end(), [&](const Touching& a, const Touching& b) {
      return std::abs(a.arc - s.arc) < std::abs(b.arc - s.arc);
    });
    if (same == old.end() || std::abs(same->arc - s.arc) > reach) {
      fresh.push_back(&s);
      continue;
    }
    touching_.push_back({s.arc, same->point, s.sticking});
    if (pieces_.front().has_bristle() && s.sticking != same->sticking) {
      events.push_back(
          {time, 0, same->point, s.arc, s.sticking ? MotionEvent::Kind::stick : MotionEvent::Kind::slip, s.slip_speed});
    }
    old.erase(same);
  }
  for (const Touching& t : old) {
    const auto [gap, rate] = gap_at(y, t.arc);
    const double when = rate > 0.0 ? std::clamp(time - gap / rate, time_before, time) : time;
    events.push_back({when, 0, t.point, t.arc, MotionEvent::Kind::lift_off, 0.0});
  }
  for (const ContactSample* s : fresh) {
    // At the speed with which the gap fell before.
    const auto [gap, rate] = gap_at(before, s->arc);
    const double speed = std::max(0.0, -rate);
    const double when = speed > 0.0 ? std::clamp(time_before + gap / speed, time_before, time) : time;
    touching_.push_back({s->arc, free_point(), s->sticking});
    events.push_back({when, 0, touching_.back().point, s->arc, MotionEvent::Kind::touch, speed});
  }
  held_states_ = touching_.empty() ? 0 : held_states_ + 1;
  return events;
}

void ContactGroup::save_state(std::vector<double>& memory) const {
  memory.push_back(static_cast<double>(touching_.size()));
  for (const Touching& t : touching_)
    memory.insert(memory.end(), {t.arc, static_cast<double>(t.point), t.sticking ? 1.0 : 0.0});
}

void ContactGroup::restore_state(std::span<const double>& memory) {
  touching_.resize(static_cast<std::size_t>(numerics::take(memory)));
  for (Touching& t : touching_) {
    t.arc = numerics::take(memory);
    t.point = static_cast<int>(numerics::take(memory));
    t.sticking = numerics::take(memory) != 0.0;
  }
  held_states_ = touching_.empty() ? 0 : 1;
}

}  // namespace snare::coupling
