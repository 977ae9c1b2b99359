#include "validation/blind_set.hpp"

#include "base/units.hpp"
#include "validation/blind_push.hpp"

#include <Eigen/QR>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace snare::validation {

namespace {

using base::mm;
constexpr double sigma = 0.05;  // of a reading [N]
constexpr int readings_a_leg = 20;
constexpr double diameter = 1.5 * mm;
constexpr double length = 176.0 * mm;
constexpr double modulus = 193e9;    // [Pa]
constexpr double density = 7930.0;   // [kg/m^3]
constexpr double radius = 6.0 * mm;  // of the pusher

struct Push {
  double position, span, travel, speed;
};
// Slack 1 mm and 0.5 mm; pushed to where the wire is taut.
constexpr Push pushes[] = {{40 * mm, 175 * mm, 2.4 * mm, 0.2 * mm},   {65 * mm, 175 * mm, 2.4 * mm, 2.0 * mm},
                           {90 * mm, 175 * mm, 2.4 * mm, 0.2 * mm},   {40 * mm, 175.5 * mm, 2.4 * mm, 2.0 * mm},
                           {65 * mm, 175.5 * mm, 2.4 * mm, 0.2 * mm}, {90 * mm, 175.5 * mm, 2.4 * mm, 2.0 * mm}};

/// The wire of one set and what a laboratory would not know of it.
struct Hidden {
  double declared_bending = 0.0, declared_axial = 0.0;
  double bending = 0.0, axial = 0.0;
  double sign = 1.0;   // of effects that go both ways
  double place = 0.0;  // of a damaged stretch, as a share of the wire
  double slip_curvature = 0.0;
  double drift_shape = 0.0;
  double clamp_compliance = 0.0;
  double highest_stress = 0.0;  // about
};

std::vector<double> travel_of(const Push& p) {
  std::vector<double> d;
  for (int i = 1; i <= readings_a_leg; ++i) d.push_back(p.travel * i / readings_a_leg);
  for (int i = readings_a_leg - 1; i >= 1; --i) d.push_back(p.travel * i / readings_a_leg);
  return d;
}

std::vector<double> time_of(const Push& p) {
  std::vector<double> t;
  for (int i = 1; i < 2 * readings_a_leg; ++i) t.push_back(p.travel / p.speed * i / readings_a_leg);
  return t;
}

BlindWire wire_of(const Push& p, const Hidden& h) {
  BlindWire w;
  w.length = length;
  w.span = p.span;
  w.bending_stiffness = h.bending;
  w.axial_stiffness = h.axial;
  w.diameter = diameter;
  w.position = p.position;
  w.radius = radius + 0.5 * diameter;
  w.mount_rotational_compliance = h.clamp_compliance;
  w.intervals = 60;
  w.history_points = 600;
  return w;
}

/// So much of an effect.
struct Dose {
  std::string effect;
  double amount = 0.0;
};

/// A bench with what is wrong with it.
struct Bench {
  BlindWire wire;
  std::vector<double> travel;
  double gain = 1.0;
  double offset = 0.0;
  double drift = 0.0;
};

void add(const Dose& dose, const Hidden& h, double highest_tension, Bench& bench) {
  const std::string& effect = dose.effect;
  const double a = dose.amount;
  const double s = h.sign * a;
  BlindWire& w = bench.wire;
  const double area = 0.25 * std::numbers::pi * diameter * diameter;
  if (effect == "wire_length")
    w.length += 0.3 * mm * s;
  else if (effect == "span")
    w.span += 0.3 * mm * s;
  else if (effect == "contact_position")
    w.position += 2.0 * mm * s;
  else if (effect == "push_misalignment")
    w.misalignment = 0.1 * s;
  else if (effect == "mount_slip")
    w.mount_slip_tension = highest_tension * std::max(0.05, 1.0 - 0.9 * a);
  else if (effect == "mount_axial_compliance")
    w.mount_axial_compliance = 1e-6 * a;
  else if (effect == "mount_rotational_compliance")
    w.mount_rotational_compliance += 2.0 * a;
  else if (effect == "contact_friction")
    w.friction = 0.4 * a;
  else if (effect == "pusher_compliance")
    w.pusher_compliance = 1e-6 * a;
  else if (effect == "displacement_offset")
    for (double& d : bench.travel) d -= 0.1 * mm * s;
  else if (effect == "force_offset")
    bench.offset = 5.0 * s;
  else if (effect == "force_gain")
    bench.gain += 0.2 * s;
  else if (effect == "natural_curvature")
    w.natural_curvature = 5.0 * s;
  else if (effect == "strand_hysteresis") {
    w.strand_extra_stiffness = h.bending * a;
    w.strand_slip_curvature = h.slip_curvature;
  } else if (effect == "plasticity")
    w.yield_stress = h.highest_stress * std::max(0.05, 4.0 - 3.9 * a);
  else if (effect == "gravity")
    w.weight = {0.0, 9.81 * density * area * s};
  else if (effect == "rate_viscosity")
    w.relaxation_time = 0.1 * a;
  else if (effect == "damage") {
    w.damage_from = (h.place - 0.08) * length;
    w.damage_to = (h.place + 0.08) * length;
    w.damage_factor = 1.0 - 0.9 * std::min(a, 1.0);
  } else if (effect == "drift")
    bench.drift = 3.0 * s;
}

// Readings of one push with these effects, without noise.
std::vector<double> read(const std::vector<Dose>& doses, const Push& p, const Hidden& h, double highest_tension) {
  Bench bench{.wire = wire_of(p, h), .travel = travel_of(p)};
  for (const Dose& dose : doses) add(dose, h, highest_tension, bench);
  const std::vector<double> time = time_of(p);
  std::vector<double> force;
  for (const BlindReading& r : blind_push(bench.wire, bench.travel, time))
    force.push_back(bench.gain * r.force + bench.offset);
  // Warming up: towards a limit within some tens of seconds.
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += bench.drift * (1.0 - std::exp(-time[i] / h.drift_shape));
  return force;
}

Eigen::VectorXd read_all(const std::vector<Dose>& doses, const Hidden& h, double highest_tension) {
  std::vector<double> all;
  for (const Push& p : pushes) {
    const std::vector<double> one = read(doses, p, h, highest_tension);
    all.insert(all.end(), one.begin(), one.end());
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

}  // namespace

const std::vector<std::string>& blind_effects() {
  static const std::vector<std::string> all{"wire_length",
                                            "span",
                                            "contact_position",
                                            "push_misalignment",
                                            "mount_slip",
                                            "mount_axial_compliance",
                                            "mount_rotational_compliance",
                                            "contact_friction",
                                            "pusher_compliance",
                                            "displacement_offset",
                                            "force_offset",
                                            "force_gain",
                                            "natural_curvature",
                                            "strand_hysteresis",
                                            "plasticity",
                                            "gravity",
                                            "rate_viscosity",
                                            "damage",
                                            "drift"};
  return all;
}

std::vector<std::string> effects_in(const std::string& name) {
  std::vector<std::string> effects;
  for (std::size_t at = 0; at <= name.size();) {
    const std::size_t end = std::min(name.find('+', at), name.size());
    effects.push_back(name.substr(at, end - at));
    at = end + 1;
  }
  return effects;
}

BlindSet make_blind_set(const std::string& effect, double size, unsigned seed) {
  const auto& known = blind_effects();
  const std::vector<std::string> inside = effect == "none" ? std::vector<std::string>() : effects_in(effect);
  for (const std::string& one : inside) {
    if (std::find(known.begin(), known.end(), one) == known.end())
      throw std::invalid_argument("no blind effect " + one);
  }
  std::mt19937 random(7919u * seed + 17u);
  // Noise of its own for every set: a seed whose noise happens to look like an effect must not count many times.
  const auto place = [&](const std::string& one) {
    return static_cast<unsigned>(std::find(known.begin(), known.end(), one) - known.begin());
  };
  unsigned which = inside.empty() ? place(effect) : 0;
  for (const std::string& one : inside) which = 100 * which + place(one);
  std::seed_seq own{seed, which, static_cast<unsigned>(std::lround(10.0 * size))};
  std::mt19937 noise(own);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Hidden h;
  h.declared_bending = 0.5 * modulus * std::numbers::pi * std::pow(diameter, 4) / 64.0;
  h.declared_axial = 0.5 * modulus * std::numbers::pi * diameter * diameter / 4.0;
  h.bending = h.declared_bending * std::exp(0.1 * normal(random));
  h.axial = h.declared_axial * std::exp(0.1 * normal(random));
  h.sign = uniform(random) < 0.5 ? -1.0 : 1.0;
  h.place = 0.3 + 0.4 * uniform(random);
  h.slip_curvature = 0.1 + 0.4 * uniform(random);
  h.drift_shape = 5.0 + 20.0 * uniform(random);
  // A uniform natural curvature does nothing between rigid clamps.
  const bool curved = std::find(inside.begin(), inside.end(), "natural_curvature") != inside.end();
  h.clamp_compliance = curved ? 0.5 : 0.0;

  double highest_tension = 0.0;
  for (const Push& p : pushes) {
    for (const BlindReading& r : blind_push(wire_of(p, h), travel_of(p), time_of(p))) {
      highest_tension = std::max(highest_tension, r.tension_left);
    }
  }
  // Of tension, or of the buckled shape: amplitude 2 sqrt(slack / L) of the tangent, E of the strand.
  const double slack = length - pushes[0].span;
  h.highest_stress =
      std::max(highest_tension * 4.0 / (std::numbers::pi * diameter * diameter),
               0.5 * modulus * 0.5 * diameter * 4.0 * std::numbers::pi / length * std::sqrt(slack / length));
  const Eigen::VectorXd plain = read_all({}, h, highest_tension);
  Eigen::VectorXd force = plain;
  BlindSet set;
  set.effect = effect;
  set.bending_stiffness = h.bending;
  set.axial_stiffness = h.axial;
  std::vector<Dose> doses;
  for (const std::string& one : inside) {
    Eigen::MatrixXd base(plain.size(), 2);
    for (const int k : {0, 1}) {
      Hidden other = h;
      (k == 0 ? other.bending : other.axial) *= 1.001;
      base.col(k) = read_all({}, other, highest_tension) - plain;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(base);
    // Two steps of Gauss and Newton for the base numbers: a mount that gives moves EA by a tenth, and not linearly.
    const auto size_of = [&](const Eigen::VectorXd& changed) {
      Hidden fitted = h;
      Eigen::VectorXd left = changed - plain;
      for (int k = 0; k < 2; ++k) {
        const Eigen::VectorXd step = 1e-3 * qr.solve(left);
        fitted.bending *= std::exp(std::clamp(step[0], -0.5, 0.5));
        fitted.axial *= std::exp(std::clamp(step[1], -0.5, 0.5));
        left = changed - read_all({}, fitted, highest_tension);
      }
      return (left - base * qr.solve(left)).norm() / sigma;
    };
    // The size rises steadily with the amount: proportional steps, held inside what is known to be too small
    // and too large.
    double low = 0.0;
    double high = 1.0;
    double a = one == "plasticity" ? 0.5 : 0.05;
    double reached = 0.0;
    Dose dose{one, a};
    for (int k = 0; k < 20; ++k) {
      dose.amount = a;
      force = read_all({dose}, h, highest_tension);
      reached = size_of(force);
      if (std::abs(reached / size - 1.0) < 0.05 || (a >= 1.0 && reached < size)) break;
      (reached < size ? low : high) = a;
      a *= std::clamp(size / std::max(reached, 1e-9), 0.1, 10.0);
      if (a <= low || a >= high) a = high < 1.0 || reached > size ? 0.5 * (low + high) : 1.0;
    }
    set.amount = doses.empty() ? dose.amount : set.amount;
    set.size = doses.empty() ? reached : std::min(set.size, reached);
    doses.push_back(dose);
  }
  if (doses.size() > 1) force = read_all(doses, h, highest_tension);

  identification::Experiment& experiment = set.experiment;
  experiment.file = "blind.toml";
  experiment.title = fmt::format("blind set {}", seed);
  experiment.free = {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N"};
  Eigen::Index row = 0;
  int number = 0;
  for (const Push& p : pushes) {
    identification::Series series;
    series.name = fmt::format("p{}", ++number);
    coupling::PushProblem& t = series.test;
    t.wire.construction = wire::Construction::strand;
    t.wire.diameter = diameter;
    t.wire.length = length;
    t.wire.youngs_modulus = modulus;
    t.wire.poisson_ratio = 0.29;
    t.wire.density = density;
    t.wire.bending_stiffness_override = h.declared_bending;
    t.wire.axial_stiffness_override = h.declared_axial;
    t.mount.span = p.span;
    if (h.clamp_compliance > 0.0) t.mount.rotational_stiffness = 1.0 / h.clamp_compliance;
    t.pusher.radius = radius;
    t.contact_position = p.position;
    identification::Readings readings;
    readings.displacement = travel_of(p);
    readings.time = time_of(p);
    for (std::size_t i = 0; i < readings.displacement.size(); ++i)
      readings.force.push_back(force[row++] + sigma * normal(noise));
    t.travel = readings.displacement;
    series.readings = readings;
    series.force_sigma = sigma;
    experiment.series.push_back(std::move(series));
  }
  return set;
}

}  // namespace snare::validation
