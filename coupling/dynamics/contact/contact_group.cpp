#include "coupling/dynamics/contact/contact_group.hpp"

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
  // Stretches are the same when they have moved by no more than an element.
  touches_ = ContactTouches(pieces_.front().search().curve().longest(), pieces_.front().has_bristle());
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
    for (const ContactSample& s : p.samples(y)) take_in(s, sum);
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

std::pair<double, double> ContactGroup::gap_at(const VectorView& y, double coordinate) const {
  std::pair<double, double> nearest{std::numeric_limits<double>::infinity(), 0.0};
  for (const ContactPart& p : pieces_) nearest = std::min(nearest, p.gap_at(y, coordinate));
  return nearest;
}

std::vector<MotionEvent> ContactGroup::observe(double time, const ContactSample& sample, const VectorView& y,
                                               double time_before, const VectorView& before) {
  return touches_.observe(sample, {time, y}, {time_before, before},
                          [this](const VectorView& at, double coordinate) { return gap_at(at, coordinate); });
}

}  // namespace snare::coupling
