// What the contact of two wires does in all, its samples and its events.

#include "base/index.hpp"
#include "coupling/dynamics/contact/contact_integral.hpp"
#include "coupling/dynamics/contact/wire_pair_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::coupling {

using Eigen::Vector3d;
using numerics::VectorView;

WirePairPart::Sums WirePairPart::sums(const VectorView& y) const {
  Sums sum;
  for (auto& wire : sum.on_mounts) wire.fill(Vector3d::Zero());
  const ContactCache& found = found_at(y);
  for (std::size_t q = 0; q < found.nodes.size(); ++q) {
    const QuadraturePoint& n = found.nodes[q];
    const PairGeometry& g = found.geometries[q];
    sum.force += (n.own == 0 ? n.weight : -n.weight) * g.force;
    sum.normal += n.weight * g.state.normal;
    sum.energy += n.weight * pair_.foundation.energy(g.gap);
    // What is taken from both wires, less what foundation and bristles store.
    const double damped = (g.elastic[0] - g.state.normal) * g.gap_rate;
    double rubbed = g.friction.force.dot(g.state.sliding);
    if (has_bristle()) {
      rubbed = 0.0;
      for (std::size_t h = 0; h < 2; ++h) rubbed += n.shape_functions[h] * bristle_flow_at(n, h, g, y).heat;
    }
    sum.lost_power += n.weight * (damped + rubbed);
    for (std::size_t s = 0; s < 2; ++s) {
      const std::size_t w = wire_of(n, s);
      const NodalLoad load = nodal_load(n, g, s);
      sum.held_moment += load.held_moment;
      for (int k = 0; k < 4; ++k) {
        const int i = n.places[s].first + k;
        if (i != 0 && i != rods_[w]->vertices() - 1) continue;
        for (int a = 0; a < 3; ++a) {
          if (rods_[w]->is_held(i, a)) sum.on_mounts[w][i == 0 ? 0 : 1][a] += load.force[base::at(k)][a];
        }
      }
    }
  }
  for (std::size_t w = 0; has_bristle() && w < 2; ++w) {
    const BristleMeans::Held held =
        found.bristles[w].held(pair_.friction, y.segment(bristles_[w], 2 * rods_[w]->vertices()));
    sum.energy += held.energy;
    sum.lost_power += held.heat;
  }
  return sum;
}

void WirePairPart::set_bristle_rates(const Eigen::VectorXd& y, Eigen::VectorXd& rate) const {
  if (!has_bristle()) return;
  const ContactCache& found = found_at(y);
  for (std::size_t w = 0; w < 2; ++w)
    rate.segment(bristles_[w], 2 * rods_[w]->vertices()) = found.bristles[w].rates.reshaped();
}

// Stretches of the first wire are points of the contact; what is integrated along the second wire belongs to
// the one beside which it acts.
ContactSample WirePairPart::closed_sample(const VectorView& y) const {
  ContactSample sum;
  const ContactCache& found = found_at(y);
  struct Point {
    double from = 0.0, to = 0.0;  // along the first wire [m]
    ContactSample sample;
  };
  std::vector<Point> points;
  const double round_off = 1e-9 * search_.curve(0).longest();
  for (const Stretch& s : found.stretches) {
    if (s.own != 0) continue;
    if (points.empty() || s.from > points.back().to + round_off) points.push_back({s.from, s.to, {}});
    points.back().to = std::max(points.back().to, s.to);
  }
  const auto nearest = [&](double arc) -> ContactSample& {
    double least = search_.curve(0).longest();
    Point* best = nullptr;
    for (Point& p : points) {
      const double away = std::max({0.0, p.from - arc, arc - p.to});
      if (away < least) {
        least = away;
        best = &p;
      }
    }
    return best != nullptr ? best->sample : points.emplace_back(Point{arc, arc, {}}).sample;
  };
  for (std::size_t q = 0; q < found.nodes.size(); ++q) {
    const QuadraturePoint& n = found.nodes[q];
    const PairGeometry& g = found.geometries[q];
    const std::size_t first = n.own == 0 ? 0 : 1;  // place that is on the first wire
    const QuadraturePoint::Place& p = n.places[first];
    const double arc = search_.curve(0).begin(p.element) + p.u * search_.curve(0).length(p.element);
    const double normal = n.weight * g.state.normal;
    ContactSample& s = nearest(arc);
    s.closed = true;
    s.gap = std::min({s.gap, g.gap, found.stretches[n.stretch].gap});
    s.force += (first == 0 ? n.weight : -n.weight) * g.force;
    s.normal_force += normal;
    s.point += normal * g.sides[first].x;
    s.arc += normal * arc;
    s.slip_speed += normal * g.state.sliding.norm();
    if (!has_bristle()) continue;
    // The slider of what sticks stands still.
    if (g.of_bristles[n.shape_functions[1] > n.shape_functions[0] ? 1 : 0].slider_speed <= standing)
      s.sticking = true;
  }
  for (Point& p : points) {
    ContactSample& s = p.sample;
    if (s.normal_force <= 0.0) continue;
    s.point /= s.normal_force;
    s.arc /= s.normal_force;
    s.slip_speed /= s.normal_force;
    take_in(s, sum);
  }
  return sum;
}

ContactSample WirePairPart::sample(const numerics::DaePoint& at) const {
  const VectorView& y = at.y;
  ContactSample s = closed_sample(y);
  if (s.closed) return s;
  const NearestPoints n = search_.nearest(y);
  s.gap = n.gap;
  s.arc = n.coordinates[0];
  const BezierWire& curve = search_.curve(0);
  const int e = curve.element_at(s.arc);
  s.point = curve.control(e, y) * bernstein(std::clamp((s.arc - curve.begin(e)) / curve.length(e), 0.0, 1.0));
  return s;
}

std::pair<double, double> WirePairPart::gap_at(const VectorView& y, double coordinate) const {
  const BezierWire &curve = search_.curve(0), &other = search_.curve(1);
  CubicPieces pieces(other.elements());
  for (int e = 0; e < other.elements(); ++e) pieces.set(e, other.control(e, y));
  const int element = curve.element_at(coordinate);
  const double u = std::clamp((coordinate - curve.begin(element)) / curve.length(element), 0.0, 1.0);
  const Vector3d x = curve.control(element, y) * bernstein(u);
  const FootPoint foot = foot_point(pieces, 0, other.elements() - 1, x);
  QuadraturePoint n;
  n.places = {place(0, element, u), place(1, foot.element, foot.u)};
  WirePair without = pair_;
  without.friction = {};
  const PairGeometry g = pair_geometry(without, pair_.radii,
                                       {side(0, n.places[0], y), side(1, n.places[1], y)}, foot.stands, {});
  return {g.gap, g.gap_rate};
}

std::optional<base::InputProblem> WirePairPart::overlap(const VectorView& y, double tolerance) const {
  const NearestPoints n = search_.nearest(y);
  if (n.gap >= -0.01 * std::min(pair_.radii[0], pair_.radii[1]) - tolerance) return {};
  return base::InputProblem{"", 0, pair_.name + ".gap",
                            fmt::format("{} at {} m along the one wire and {} m along the other", n.gap,
                                        n.coordinates[0], n.coordinates[1]),
                            "must be >= 0 m at the start"};
}

// Both wires are counted: what their contact does to momentum is what it presses on rigidly held components,
// and what it does not twist them.
void WirePairPart::add_rates(const numerics::DaePoint& at, const IntegralRates& rates) const {
  const Sums s = sums(at.y);
  Eigen::Ref<Eigen::VectorXd> all = rates.all;
  all.segment<3>(rates.force) = s.force;
  all[rates.normal] = s.normal;
  all[integral::dissipated] += s.lost_power;
  all.segment<3>(integral::outer_moment) -= s.held_moment;
  for (std::size_t w = 0; w < 2; ++w) take_held(*rods_[w], s.on_mounts[w], at, all);
}

Interaction::Load WirePairPart::load(const numerics::DaePoint& at) const {
  const Sums s = sums(at.y);
  return {s.force, s.normal};
}

void WirePairPart::take_from_mounts(const VectorView& y, std::vector<Vector3d>& mount_forces) const {
  const Sums s = sums(y);
  for (std::size_t w = 0; w < 2; ++w) {
    for (std::size_t end = 0; end < 2; ++end)
      mount_forces[2 * base::at(pair_.wires[w]) + end] -= s.on_mounts[w][end];
  }
}

Interaction::Observed WirePairPart::observe(const numerics::DaePoint& now, double time_before,
                                            const Eigen::VectorXd& before) {
  const ContactSample sum = closed_sample(now.y);
  return observed(sum, touches_.observe(sum, {now.time, now.y}, {time_before, before},
                                        [this](const VectorView& y, double arc) { return gap_at(y, arc); }));
}

}  // namespace snare::coupling
