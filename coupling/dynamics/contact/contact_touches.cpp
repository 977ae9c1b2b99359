#include "coupling/dynamics/contact/contact_touches.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::coupling {

void take_in(const ContactSample& one, ContactSample& sum) {
  if (!sum.closed || one.normal_force > sum.points[0].normal_force) {
    sum.gap = one.gap;
    sum.point = one.point;
    sum.arc = one.arc;
    sum.slip_speed = one.slip_speed;
    sum.sticking = one.sticking;
    sum.points.insert(sum.points.begin(), one);
  } else {
    sum.points.push_back(one);
  }
  sum.closed = true;
  sum.force += one.force;
  sum.normal_force += one.normal_force;
}

ContactSample with_force(ContactSample sample, const Eigen::Vector3d& force, double normal) {
  if (sample.points.empty()) sample.points.push_back(sample);
  const double share = 1.0 / static_cast<double>(sample.points.size());
  for (ContactSample& p : sample.points) {
    const double part = sample.normal_force > 0.0 ? p.normal_force / sample.normal_force : share;
    p.closed = true;
    p.normal_force = part * std::max(normal, 0.0);
    p.force = part * force;
  }
  sample.closed = true;
  sample.normal_force = std::max(normal, 0.0);
  sample.force = force;
  return sample;
}

int ContactTouches::free_point() const {
  int point = 0;
  while (std::any_of(touching_.begin(), touching_.end(),
                     [point](const Touching& t) { return t.point == point; }))
    ++point;
  return point;
}

std::vector<MotionEvent> ContactTouches::observe(const ContactSample& sample, const Seen& now,
                                                 const Seen& before, const GapAt& gap_at) {
  std::vector<MotionEvent> events;
  std::vector<Touching> old = std::exchange(touching_, {});
  std::vector<const ContactSample*> fresh;
  for (const ContactSample& s : sample.points) {
    const auto same = std::min_element(old.begin(), old.end(), [&](const Touching& a, const Touching& b) {
      return std::abs(a.arc - s.arc) < std::abs(b.arc - s.arc);
    });
    if (same == old.end() || std::abs(same->arc - s.arc) > reach_) {
      fresh.push_back(&s);
      continue;
    }
    touching_.push_back({s.arc, same->point, s.sticking});
    if (sticks_ && s.sticking != same->sticking) {
      events.push_back({now.time, 0, same->point, s.arc,
                        s.sticking ? MotionEvent::Kind::stick : MotionEvent::Kind::slip, s.slip_speed});
    }
    old.erase(same);
  }
  for (const Touching& t : old) {
    const auto [gap, rate] = gap_at(now.y, t.arc);
    const double when = rate > 0.0 ? std::clamp(now.time - gap / rate, before.time, now.time) : now.time;
    events.push_back({when, 0, t.point, t.arc, MotionEvent::Kind::lift_off, 0.0});
  }
  for (const ContactSample* s : fresh) {
    // At the speed with which the gap fell before.
    const auto [gap, rate] = gap_at(before.y, s->arc);
    const double speed = std::max(0.0, -rate);
    const double when = speed > 0.0 ? std::clamp(before.time + gap / speed, before.time, now.time) : now.time;
    touching_.push_back({s->arc, free_point(), s->sticking});
    events.push_back({when, 0, touching_.back().point, s->arc, MotionEvent::Kind::touch, speed});
  }
  held_states_ = touching_.empty() ? 0 : held_states_ + 1;
  return events;
}

void ContactTouches::save_state(std::vector<double>& memory) const {
  memory.push_back(static_cast<double>(touching_.size()));
  for (const Touching& t : touching_)
    memory.insert(memory.end(), {t.arc, static_cast<double>(t.point), t.sticking ? 1.0 : 0.0});
}

void ContactTouches::restore_state(std::span<const double>& memory) {
  touching_.resize(static_cast<std::size_t>(numerics::take(memory)));
  for (Touching& t : touching_) {
    t.arc = numerics::take(memory);
    t.point = static_cast<int>(numerics::take(memory));
    t.sticking = numerics::take(memory) != 0.0;
  }
  held_states_ = touching_.empty() ? 0 : 1;
}

}  // namespace snare::coupling
