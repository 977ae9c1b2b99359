#include "coupling/dynamics/contact/contact_search.hpp"

#include "base/index.hpp"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace snare::coupling {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using multibody::Pose;
using numerics::VectorView;

ContactSearch::ContactSearch(const MotionContact& contact, std::shared_ptr<const ContactShape> shape,
                             const wire::RodPart& rod, const BodyPart& body)
    : shape_(std::move(shape)),
      X_BS_(contact.X_BS),
      wire_radius_(contact.wire_radius),
      rod_(rod),
      body_(body),
      curve_(rod) {
  // The gap's curvature along a straight wire that touches is at most one over the sum of the radii; a
  // quarter of that length shows every minimum. A wire that bends round a large shape shows two within an
  // element: a quarter of that. An element is not cut into more than 64.
  constexpr double share = 0.25, most_pieces = 64.0;
  const double radius = wire_radius_ + shape_->smallest_radius();
  resolution_ = std::max(share * std::min(radius, std::max(wire_radius_, curve_.shortest())),
                         curve_.shortest() / most_pieces);
  margin_ = std::max(2.0 * wire_radius_, 0.5 * curve_.longest());
  thickness_ = radius > 0.0 ? radius : curve_.shortest();
  free_until_.assign(base::at(curve_.elements()), 0.0);
  last_bound_ = free_until_;
}

Pose ContactSearch::X_WS(const VectorView& y) const {
  return Pose{multibody::rotation(y.segment<4>(body_.quaternion())), y.segment<3>(body_.position())} * X_BS_;
}

BezierWire::Control ContactSearch::control(const Pose& X_WS, int element, const VectorView& y) const {
  return X_WS.R.transpose() * (curve_.control(element, y).colwise() - X_WS.p);
}

// The distance changes by no more than the way: nothing within a ball is nearer than its centre less its
// radius.
double ContactSearch::lower_bound(const BezierWire::Control& control) const {
  const AlignedBox3d box(control.rowwise().minCoeff(), control.rowwise().maxCoeff());
  return shape_->distance(box.center()) - 0.5 * box.diagonal().norm() - wire_radius_;
}

// An element whose gap was g when the way was w meets nothing before the way is w + g. Its distance is looked
// up where half of that is gone: what goes away may take longer steps.
void ContactSearch::update(const VectorView& y) {
  const Pose where = X_WS(y);
  const Vector3d spin = where.R.transpose() * (multibody::rotation(y.segment<4>(body_.quaternion())) *
                                               Vector3d(y.segment<3>(body_.spin())));
  const Vector3d origin_speed = where.R.transpose() * y.segment<3>(body_.velocity()) -
                                spin.cross(where.R.transpose() * (y.segment<3>(body_.position()) - where.p));
  const bool first = last_.cols() == 0;
  if (first) last_.resize(3, rod_.vertices());
  speeds_.resize(rod_.vertices());
  double way = 0.0;
  for (int i = 0; i < rod_.vertices(); ++i) {
    const Vector3d x = where.R.transpose() * (y.segment<3>(rod_.position_of(i)) - where.p);
    const Vector3d v = where.R.transpose() * y.segment<3>(rod_.velocity_of(i)) - origin_speed - spin.cross(x);
    if (!first) way = std::max(way, (x - last_.col(i)).norm());
    speeds_[i] = v.norm();
    last_.col(i) = x;
  }
  passed_ += curve_.largest_weight_sum() * way;
  candidates_.clear();
  double clear = std::numeric_limits<double>::infinity();
  double fastest = 0.0;  // of the candidates
  for (int e = 0; e < curve_.elements(); ++e) {
    double &until = free_until_[base::at(e)], &looked_up = last_bound_[base::at(e)];
    if (until - passed_ < std::max(margin_, 0.5 * looked_up)) {
      looked_up = lower_bound(control(where, e, y));
      until = passed_ + looked_up;
      if (looked_up < margin_) {
        candidates_.push_back(e);
        fastest = std::max(fastest, speeds_.segment<4>(curve_.first_vertex(e)).maxCoeff());
        continue;
      }
    }
    clear = std::min(clear, until - passed_);
  }
  const double speed = 2.0 * curve_.largest_weight_sum();
  longest_step_ = 1.0 / (speed * std::max(speeds_.maxCoeff() / clear, fastest / thickness_));
}

// The boxes in the order of their bounds, until none can hold anything nearer; in each the gap at places that
// no minimum passes.
NearestPoint ContactSearch::nearest(const VectorView& y) const {
  const Pose where = X_WS(y);
  std::vector<std::pair<double, int>> order;
  for (int e = 0; e < curve_.elements(); ++e) order.emplace_back(lower_bound(control(where, e, y)), e);
  std::sort(order.begin(), order.end());
  NearestPoint best{0.0, std::numeric_limits<double>::infinity()};
  for (const auto& [bound, element] : order) {
    if (bound >= best.gap) break;
    const int e = element;
    const BezierWire::Control c = control(where, e, y);
    const auto gap = [&](double u) { return shape_->distance(c * bernstein(u)) - wire_radius_; };
    const auto look = [&](double u) {
      const double g = gap(u);
      if (g < best.gap) best = {curve_.begin(e) + u * curve_.length(e), g};
      return g;
    };
    const int cuts = std::max(2, static_cast<int>(std::ceil(curve_.length(e) / resolution_)));
    double lowest = std::numeric_limits<double>::infinity();
    int at = 0;
    for (int k = 0; k <= cuts; ++k) {
      const double g = look(static_cast<double>(k) / cuts);
      if (g < lowest) {
        lowest = g;
        at = k;
      }
    }
    const auto [u, g] = boost::math::tools::brent_find_minima(gap, std::max(0.0, (at - 1.0) / cuts),
                                                              std::min(1.0, (at + 1.0) / cuts), 30);
    if (g < best.gap) best = {curve_.begin(e) + u * curve_.length(e), g};
  }
  return best;
}

}  // namespace snare::coupling
