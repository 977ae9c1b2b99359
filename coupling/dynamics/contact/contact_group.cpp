#include "coupling/dynamics/contact/contact_group.hpp"

#include "coupling/contact/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace snare::coupling {

using numerics::VectorView;

ContactGroup::ContactGroup(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body)
    : contact_(contact), rod_(rod), body_(body) {
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

void ContactGroup::append(std::vector<numerics::DaePart*>& parts) {
  for (ContactPart& p : pieces_) parts.push_back(&p);
}

// The start may touch, up to a small part of the wire's radius.
std::optional<base::InputProblem> ContactGroup::overlap(const VectorView& y, double tolerance) const {
  const NearestPoint n = nearest(y);
  if (is_law() || n.gap >= -0.01 * contact_.wire_radius - tolerance) return {};
  return base::InputProblem{"", 0, contact_.name + ".gap",
                            fmt::format("{} at {} m along the wire", n.gap, n.coordinate),
                            "must be >= 0 m at the start"};
}

void ContactGroup::update_candidates(const VectorView& y) {
  for (ContactPart& p : pieces_) p.update_candidates(y);
}

void ContactGroup::set_bristle_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const {
  for (const ContactPart& p : pieces_) p.set_bristle_rates(y, rate);
}

std::vector<int> ContactGroup::restrict_to_plane(int normal) {
  std::vector<int> across;
  for (ContactPart& p : pieces_) {
    const std::vector<int> own = p.restrict_to_plane(normal);
    across.insert(across.end(), own.begin(), own.end());
  }
  return across;
}

void ContactGroup::leave_plane() {
  for (ContactPart& p : pieces_) p.leave_plane();
}

// What a driven body gives, with its work, comes from outside.
void ContactGroup::add_rates(const numerics::DaePoint& at, const IntegralRates& rates) const {
  const ContactPart::Sums s = sums(at.y);
  Eigen::Ref<Eigen::VectorXd> all = rates.all;
  all.segment<3>(rates.force) += s.force;
  all[rates.normal] = s.normal;
  all[integral::dissipated] += s.lost_power;
  take_held(rod_, s.on_mounts, at, all);
  if (body_.moves_freely()) return;
  all[integral::work] += s.body_power;
  all.segment<3>(integral::outer) += s.force;
  all.segment<3>(integral::outer_moment) += s.moment;
}

Interaction::Load ContactGroup::load(const numerics::DaePoint& at) const {
  const ContactPart::Sums s = sums(at.y);
  return {s.force, s.normal};
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

ContactSample ContactGroup::sample(const numerics::DaePoint& at) const {
  const VectorView& y = at.y;
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

void ContactGroup::take_from_mounts(const VectorView& y, std::vector<Eigen::Vector3d>& mount_forces) const {
  const ContactPart::Sums s = sums(y);
  const auto left = 2 * static_cast<std::size_t>(contact_.wire);
  mount_forces[left] -= s.on_mounts[0];
  mount_forces[left + 1] -= s.on_mounts[1];
}

Interaction::Observed ContactGroup::observe(const numerics::DaePoint& now, double time_before,
                                            const Eigen::VectorXd& before) {
  const ContactSample sum = closed_sample(now.y);
  Observed seen =
      observed(sum, touches_.observe(sum, {now.time, now.y}, {time_before, before},
                                     [this](const VectorView& y, double arc) { return gap_at(y, arc); }));
  if (is_law()) seen.penetration = 0.0;
  return seen;
}

}  // namespace snare::coupling
