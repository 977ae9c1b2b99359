#include "identification/fitting/shared_push.hpp"

#include <algorithm>
#include <tuple>

namespace snare::identification {

using coupling::PushProblem;

namespace {

// Every member, by structured bindings: one that is added does not compile until it is compared.

auto members(const wire::StrandFriction& s) {
  const auto& [extra, slip, breadth] = s;
  return std::tuple(extra, slip, breadth);
}

auto members(const wire::Yielding& y) {
  const auto& [stress, hardening] = y;
  return std::tuple(stress, hardening);
}

template <class T>
bool equal(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || members(*a) == members(*b));
}

bool equal(const wire::WireSpecification& a, const wire::WireSpecification& b) {
  const auto plain = [](const wire::WireSpecification& w) {
    const auto& [construction, diameter, length, modulus, poisson, density, bending, axial, torsional,
                 natural, strands, yielding, profile] = w;
    return std::tuple(construction, diameter, length, modulus, poisson, density, bending, axial, torsional,
                      natural, profile);
  };
  return plain(a) == plain(b) && equal(a.strand_friction, b.strand_friction) && equal(a.yielding, b.yielding);
}

auto members(const wire::MountSpecification& m) {
  const auto& [kind, span, radius, translational, rotational, own_translational, own_rotational, slip_tension,
               slip, slip_at] = m;
  return std::tuple(kind, span, radius, translational, rotational, own_translational, own_rotational,
                    slip_tension, slip, slip_at);
}

auto members(const coupling::PusherSpecification& p) {
  const auto& [radius, friction, compliance, direction, tilt, misalignment] = p;
  return std::tuple(radius, friction, compliance, direction, tilt, misalignment);
}

auto members(const coupling::BulgeSpecification& b) {
  const auto& [mode, plane] = b;
  return std::tuple(mode, plane);
}

bool same_push(const PushProblem& a, const PushProblem& b) {
  const auto& [wire, mount, pusher, bulge, gravity, position, travel] = a;  // travel: that of the readings
  return equal(wire, b.wire) && members(mount) == members(b.mount) && members(pusher) == members(b.pusher) &&
         members(bulge) == members(b.bulge) && gravity == b.gravity && position == b.contact_position;
}

auto members(const ReadingModel& r) {
  const auto& [displacement, force, gain, relaxation, travel_bow, force_bow, lag, play, creep, creep_time,
               drift] = r;
  return std::tuple(displacement, force, gain, relaxation, travel_bow, force_bow, lag, play, creep,
                    creep_time, drift);
}

/// A dense record of one loading: the curve is that of any other, whatever its readings.
bool one_way(const Series& series) {
  const std::vector<double>& d = measured_displacement(series);
  if (d.size() <= dense_leg) return false;
  const std::vector<Leg> legs = legs_of(d);
  return legs.size() == 1 && legs.front().up;
}

}  // namespace

std::vector<std::vector<std::size_t>> shared_pushes(const std::vector<Series>& declared,
                                                    const std::vector<Series>& applied,
                                                    const std::vector<ReadingModel>& reading) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < declared.size(); ++k) {
    const auto alike = [&](const std::vector<std::size_t>& group) {
      const std::size_t j = group.front();
      return one_way(declared[j]) && same_push(declared[j].test, declared[k].test) &&
             same_push(applied[j].test, applied[k].test) && members(reading[j]) == members(reading[k]);
    };
    // Where the record hangs on times, those of every record count.
    const bool may = !needs_times(reading[k]) && one_way(declared[k]);
    const auto at = may ? std::find_if(groups.begin(), groups.end(), alike) : groups.end();
    if (at == groups.end())
      groups.push_back({k});
    else
      at->push_back(k);
  }
  return groups;
}

Series merged(const std::vector<Series>& series, const std::vector<std::size_t>& group) {
  Series result = series[group.front()];
  Readings all;
  for (const std::size_t k : group) {
    const std::vector<double>& d = measured_displacement(series[k]);
    all.displacement.insert(all.displacement.end(), d.begin(), d.end());
  }
  std::sort(all.displacement.begin(), all.displacement.end());
  all.force.assign(all.displacement.size(), 0.0);
  result.readings = std::move(all);
  return result;
}

Prediction part_of(const Prediction& whole, const Series& merged, const Series& one) {
  Prediction result;
  result.curve = whole.curve;
  result.reading = whole.reading;
  result.before_touch = whole.before_touch;
  const std::vector<double>& all = measured_displacement(merged);
  if (whole.force.size() != all.size()) {
    result.force_by.setZero(0, whole.force_by.cols());
    return result;
  }
  std::vector<Eigen::Index> rows;
  for (const double d : measured_displacement(one))
    rows.push_back(std::lower_bound(all.begin(), all.end(), d) - all.begin());
  for (const Eigen::Index row : rows) {
    const auto i = static_cast<std::size_t>(row);
    result.force.push_back(whole.force[i]);
    result.wire.force.push_back(whole.wire.force[i]);
    result.mount_pull.push_back(whole.mount_pull[i]);
    if (!whole.wire.viscous.empty()) result.wire.viscous.push_back(whole.wire.viscous[i]);
  }
  result.force_by = whole.force_by(rows, Eigen::all);
  return result;
}

}  // namespace snare::identification
