#include "coupling/dynamics/contact_points.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

// A touch is noticed this far inside [m]: a point that has just let go stands at zero up to round-off, and must be
// taken for open until it comes back.
constexpr double touch_depth = 1e-11;

// Beside a point that rests on the wire [m].
constexpr double dip_depth = 1e-9;

// Minima this near [m] when another touches do so at the same time: shapes that touch together differ by round-off. At most a hundredth
// of the position tolerance.
constexpr double touch_together = 1e-9;

}  // namespace

ContactPoints::ContactPoints(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body,
                             const MotionOptions& options)
    : contact_(contact),
      rod_(rod),
      search_(contact, rod, body, options.position_tolerance),
      together_(std::min(touch_together, 0.01 * options.position_tolerance)),
      touch_(-touch_depth) {
  for (int k = 0; k < contact.points; ++k) {
    MotionContact one = contact;
    if (contact.points > 1) one.name = fmt::format("{} point {}", contact.name, k + 1);
    points_.emplace_back(one, rod, body, options);
  }
}

std::optional<std::size_t> ContactPoints::free_point() const {
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (!points_[k].closed()) return k;
  }
  return std::nullopt;
}

double ContactPoints::open(std::size_t point, VectorXd& y) {
  leave_apart(points_[point].gap(y));
  return points_[point].open(y);
}

void ContactPoints::leave_apart(double gap) {
  touch_ = std::min(touch_, gap - touch_depth);
}

void ContactPoints::save_state(std::vector<double>& memory) const {
  memory.push_back(touch_);
}

void ContactPoints::restore_state(std::span<const double>& memory) {
  touch_ = numerics::take(memory);
}

// A point that follows its minimum stands at it, in the dense output too up to its error; one that is fixed to the wire holds no more than
// its surroundings, and what dips beside it by less than can matter: a second point there would share its masses.
std::vector<ContactSearch::Held> ContactPoints::held() const {
  std::vector<ContactSearch::Held> list;
  for (const ContactPart& p : points_) {
    if (!p.closed()) continue;
    if (p.is_fixed_to_wire()) {
      list.push_back({p.coordinate_unknown(), 0.05 * search_.resolution(), search_.longest_element(), dip_depth});
    } else {
      list.push_back({p.coordinate_unknown(), 2.0 * search_.resolution(), 0.0, 0.0});
    }
  }
  return list;
}

std::optional<double> ContactPoints::first_touch(const ContactSearch::Step& step, double until) {
  const std::optional<double> found = search_.first_touch(step, until, held(), touch_);
  if (search_.known_clearance() > 0.0) touch_ = -touch_depth;
  return found;
}

// Where the wire lies flat any place will do, and a free vertex is taken: points at vertices move one each, and stay independent however
// many they are.
std::vector<GapMinimum> ContactPoints::touching(const VectorView& y) const {
  std::vector<GapMinimum> found;
  const auto at = [](double coordinate) {
    return [coordinate](const GapMinimum& m) { return m.coordinate == coordinate; };
  };
  for (GapMinimum m : search_.touching(y, held(), touch_ + together_)) {
    const std::optional<double> vertex = points_.front().level_vertex(m.coordinate, y);
    const bool taken = vertex && std::any_of(points_.begin(), points_.end(), [&](const ContactPart& p) {
                         return p.closed() && y[p.coordinate_unknown()] == *vertex;
                       });
    if (vertex && !taken) m.coordinate = *vertex;
    if (std::none_of(found.begin(), found.end(), at(m.coordinate))) found.push_back(m);
  }
  return found;
}

ContactSample ContactPoints::closed_sample(const DaePoint& at) const {
  ContactSample sum;
  for (const ContactPart& p : points_) {
    if (!p.closed()) continue;
    const ContactSample s = p.sample(at);
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
  return sum;
}

ContactSample ContactPoints::sample(const DaePoint& at) const {
  ContactSample s = closed_sample(at);
  if (s.closed) return s;
  const GapMinimum n = search_.nearest(at.y);
  s.gap = n.gap;
  s.arc = n.coordinate;
  const CurveWeights w = curve_weights(rod_, n.coordinate);
  for (int k = 0; k < 4; ++k) s.point += w.value[k] * at.y.segment<3>(rod_.position_of(w.first + k));
  return s;
}

}  // namespace snare::coupling
