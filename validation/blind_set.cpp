#include "validation/blind_set.hpp"

#include "base/units.hpp"
#include "validation/blind_push.hpp"

#include <Eigen/QR>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace snare::validation {

namespace {

using base::mm;
constexpr double sigma = 0.05;        // of a reading [N]
constexpr int finest_leg = 40;        // readings a leg on which noise is drawn
constexpr double deviation = 0.01;    // of a replicate, of the force
constexpr double correlation = 0.25;  // of its path, of the travel
constexpr double diameter = 1.5 * mm;
constexpr double length = 176.0 * mm;
constexpr double modulus = 193e9;    // [Pa]
constexpr double density = 7930.0;   // [kg/m^3]
constexpr double radius = 6.0 * mm;  // of the pusher

struct Push {
  double position, span, travel, speed;
};
// Slack 1 mm and 0.5 mm; pushed to where the wire is taut.
constexpr Push pushes[] = {
    {40 * mm, 175 * mm, 2.4 * mm, 0.2 * mm},   {65 * mm, 175 * mm, 2.4 * mm, 2.0 * mm},
    {90 * mm, 175 * mm, 2.4 * mm, 0.2 * mm},   {40 * mm, 175.5 * mm, 2.4 * mm, 2.0 * mm},
    {65 * mm, 175.5 * mm, 2.4 * mm, 0.2 * mm}, {90 * mm, 175.5 * mm, 2.4 * mm, 2.0 * mm}};

/// The pushes of a design.
std::vector<Push> pushes_of(const BlindDesign& design) {
  return {std::begin(pushes), std::begin(pushes) + (design.replicates > 1 ? 3 : std::size(pushes))};
}

/// The wire of one set and what a laboratory would not know of it.
struct Hidden {
  double declared_bending = 0.0, declared_axial = 0.0;
  double bending = 0.0, axial = 0.0;
  double sign = 1.0;   // of effects that go both ways
  double place = 0.0;  // of a damaged stretch, as a share of the wire
  double slip_curvature = 0.0;
  double slip_breadth = 0.0;
  double length = 0.0;
  std::vector<double> position_off;  // of the pushes
  bool right = false;                // the mount that slips
  double drift_shape = 0.0;
  double clamp_compliance = 0.0;
  double highest_stress = 0.0;  // about
};

std::vector<double> travel_of(const Push& p, int readings_a_leg) {
  std::vector<double> d;
  for (int i = 1; i <= readings_a_leg; ++i) d.push_back(p.travel * i / readings_a_leg);
  for (int i = readings_a_leg - 1; i >= 1; --i) d.push_back(p.travel * i / readings_a_leg);
  return d;
}

std::vector<double> time_of(const Push& p, int readings_a_leg) {
  std::vector<double> t;
  for (int i = 1; i < 2 * readings_a_leg; ++i) t.push_back(p.travel / p.speed * i / readings_a_leg);
  return t;
}

BlindWire wire_of(const Push& p, const Hidden& h) {
  BlindWire w;
  w.length = h.length;
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
struct Perturbation {
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

void add(const Perturbation& dose, const Hidden& h, double highest_tension, Bench& bench) {
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
  else if (effect == "mount_slip" || effect == "clamp_slide" || effect == "clamp_slide_right") {
    w.mount_slip_tension = highest_tension * std::max(0.05, 1.0 - 0.9 * a);
    w.mount_slides = effect != "mount_slip";
    w.mount_slips_right = w.mount_slides ? effect == "clamp_slide_right" : h.right;
  } else if (effect == "mount_axial_compliance")
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
    w.strand_slip_breadth = h.slip_breadth;
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

/// What the tracing calls an effect's first number, and its value.
std::pair<std::string, double> number_of(const Perturbation& dose, const Hidden& h, double highest_tension) {
  const std::string& effect = dose.effect;
  const double a = dose.amount;
  const double s = h.sign * a;
  if (effect == "wire_length") return {"wire.length_mm", (h.length + 0.3 * mm * s) / mm};
  if (effect == "contact_position") return {"contact_position.shift_mm", 2.0 * s};
  if (effect == "push_misalignment") return {"pusher.misalignment_deg", 0.1 * s * 180.0 / std::numbers::pi};
  if (effect == "mount_slip" || effect == "clamp_slide" || effect == "clamp_slide_right")
    return {effect + ".tension_N", highest_tension * std::max(0.05, 1.0 - 0.9 * a)};
  if (effect == "mount_axial_compliance") return {"mount_axial_compliance.compliance_m_N", 1e-6 * a};
  if (effect == "mount_rotational_compliance")
    return {"mount_rotational_compliance.compliance_rad_Nm", h.clamp_compliance + 2.0 * a};
  if (effect == "contact_friction") return {"pusher.friction", 0.4 * a};
  if (effect == "pusher_compliance") return {"pusher.compliance_m_N", 1e-6 * a};
  if (effect == "displacement_offset") return {"reading.displacement_offset_mm", 0.1 * s};
  if (effect == "force_offset") return {"reading.force_offset_N", 5.0 * s};
  if (effect == "natural_curvature") return {"wire.natural_curvature_1_m", 5.0 * s};
  if (effect == "strand_hysteresis") return {"strand_hysteresis.extra_stiffness_Nm2", h.bending * a};
  if (effect == "gravity") return {"gravity.along_bulge_m_s2", 9.81 * s};
  if (effect == "rate_viscosity") return {"rate_viscosity.relaxation_time_s", 0.1 * a};
  return {"", 0.0};
}

// Readings of one push with these effects, without noise.
std::vector<double> read(const std::vector<Perturbation>& doses, const Push& p, double off, const Hidden& h,
                         double highest_tension, int readings_a_leg) {
  Bench bench{.wire = wire_of(p, h), .travel = travel_of(p, readings_a_leg)};
  bench.wire.position += off;
  for (const Perturbation& dose : doses) add(dose, h, highest_tension, bench);
  const std::vector<double> time = time_of(p, readings_a_leg);
  std::vector<double> force;
  for (const BlindReading& r : blind_push(bench.wire, bench.travel, time))
    force.push_back(bench.gain * r.force + bench.offset);
  // Warming up: towards a limit within some tens of seconds.
  for (std::size_t i = 0; i < force.size(); ++i)
    force[i] += bench.drift * (1.0 - std::exp(-time[i] / h.drift_shape));
  return force;
}

// One push below the other.
Eigen::VectorXd read_all(const std::vector<Perturbation>& doses, const Hidden& h, double highest_tension,
                         const BlindDesign& design) {
  std::vector<double> all;
  const std::vector<Push> made = pushes_of(design);
  for (std::size_t k = 0; k < made.size(); ++k) {
    const std::vector<double> one =
        read(doses, made[k], h.position_off[k], h, highest_tension, design.readings_a_leg);
    all.insert(all.end(), one.begin(), one.end());
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// Makes errors of the noise and of the pushes' places independent of equal size sigma: u = (a place's
/// deviation) dF/d(place), so that sigma^2 + u u^T becomes sigma^2.
class Places {
 public:
  Places(const Hidden& h, double highest_tension, const BlindDesign& design) {
    if (design.position_deviation == 0.0) return;
    constexpr double step = 1e-5;  // [m]
    Hidden moved = h;
    for (double& off : moved.position_off) off += step;
    changes_ = design.position_deviation / step *
               (read_all({}, moved, highest_tension, design) - read_all({}, h, highest_tension, design));
    pushes_ = static_cast<Eigen::Index>(pushes_of(design).size());
  }
  [[nodiscard]] Eigen::MatrixXd white(Eigen::MatrixXd columns) const {
    for (Eigen::Index k = 0; k < pushes_; ++k) {
      const Eigen::Index n = columns.rows() / pushes_;
      const Eigen::VectorXd u = changes_.segment(k * n, n) / sigma;
      const double square = u.squaredNorm();
      const Eigen::RowVectorXd along =
          (1.0 - 1.0 / std::sqrt(1.0 + square)) / square * (u.transpose() * columns.middleRows(k * n, n));
      columns.middleRows(k * n, n) -= u * along;
    }
    return columns;
  }

 private:
  Eigen::VectorXd changes_;  // [N]
  Eigen::Index pushes_ = 0;
};

/// Deviations of a record with so many readings a leg: white noise, and a smooth one over the path where it
/// is a replicate. Drawn at the finest readings, of which every record has its own.
struct Deviations {
  std::vector<double> white;   // [N]
  std::vector<double> smooth;  // of the force [-]
};

Deviations deviations_of(int readings_a_leg, bool replicate, std::mt19937& noise) {
  std::normal_distribution<double> normal;
  Deviations result;
  const int finest = std::max(finest_leg, readings_a_leg);
  const int every = finest / readings_a_leg;
  const double decay = std::exp(-1.0 / (finest * correlation));
  double state = normal(noise);
  for (int i = 1; i < 2 * finest; ++i) {
    const double white = sigma * normal(noise);
    state = decay * state + std::sqrt(1.0 - decay * decay) * normal(noise);
    if (i % every != 0) continue;
    result.white.push_back(white);
    result.smooth.push_back(replicate ? deviation * state : 0.0);
  }
  return result;
}

}  // namespace

const std::vector<std::string>& blind_effects() {
  static const std::vector<std::string> all{"wire_length",
                                            "span",
                                            "contact_position",
                                            "push_misalignment",
                                            "mount_slip",
                                            "clamp_slide",
                                            "clamp_slide_right",
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

namespace {

/// What the wire and the bench really are, drawn once a seed whatever the effect.
Hidden hidden_of(unsigned seed, const BlindDesign& design) {
  std::mt19937 random(7919u * seed + 17u);
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
  h.right = uniform(random) < 0.5;
  // Half of the strands slide all at once.
  const double breadth = 2.0 * uniform(random);
  h.slip_breadth = uniform(random) < 0.5 ? 0.0 : breadth;
  h.length = length + design.length_deviation * normal(random);
  for (std::size_t k = 0; k < std::size(pushes); ++k)
    h.position_off.push_back(design.position_deviation * normal(random));
  return h;
}

/// Noise of its own for every set: a seed whose noise happens to look like an effect must not count many
/// times.
std::mt19937 noise_of(const std::string& effect, const std::vector<std::string>& inside, double size,
                      unsigned seed) {
  const auto& known = blind_effects();
  const auto place = [&](const std::string& one) {
    return static_cast<unsigned>(std::find(known.begin(), known.end(), one) - known.begin());
  };
  unsigned which = inside.empty() ? place(effect) : 0;
  for (const std::string& one : inside) which = 100 * which + place(one);
  std::seed_seq own{seed, which, static_cast<unsigned>(std::lround(10.0 * size))};
  return std::mt19937(own);
}

double highest_tension_of(const std::vector<Push>& made, const Hidden& h, const BlindDesign& design) {
  double highest = 0.0;
  for (std::size_t k = 0; k < made.size(); ++k) {
    BlindWire wire = wire_of(made[k], h);
    wire.position += h.position_off[k];
    for (const BlindReading& r : blind_push(wire, travel_of(made[k], design.readings_a_leg)))
      highest = std::max(highest, r.tension_left);
  }
  return highest;
}

/// Finds the amount of an effect that has a size: of its change of the readings after the fitted numbers have
/// taken from it what they can, in standard deviations.
class Dosing {
 public:
  Dosing(const Hidden& h, double highest_tension, const BlindDesign& design)
      : h_(h),
        highest_tension_(highest_tension),
        design_(design),
        plain_(read_all({}, h, highest_tension, design)),
        places_(h, highest_tension, design),
        base_(places_.white(changes())),
        qr_(base_) {}

  /// The size rises steadily with the amount: proportional steps, held inside what is known to be too small
  /// and too large. Returns the dose and its size.
  std::pair<Perturbation, double> of(const std::string& effect, double size) const {
    double low = 0.0;
    double high = 1.0;
    double a = effect == "plasticity" ? 0.5 : 0.05;
    double reached = 0.0;
    Perturbation dose{effect, a};
    for (int k = 0; k < 20; ++k) {
      dose.amount = a;
      reached = size_of(read(dose));
      if (std::abs(reached / size - 1.0) < 0.05 || (a >= 1.0 && reached < size)) break;
      (reached < size ? low : high) = a;
      a *= std::clamp(size / std::max(reached, 1e-9), 0.1, 10.0);
      if (a <= low || a >= high) a = high < 1.0 || reached > size ? 0.5 * (low + high) : 1.0;
    }
    return {dose, reached};
  }
  [[nodiscard]] Eigen::VectorXd read(const Perturbation& dose) const {
    return read_all({dose}, h_, highest_tension_, design_);
  }

 private:
  static constexpr double ratio = 1e-3;   // of a stiffness
  static constexpr double longer = 1e-5;  // [m]

  /// Of the readings by the fitted numbers.
  [[nodiscard]] Eigen::MatrixXd changes() const {
    Eigen::MatrixXd result(plain_.size(), design_.length_deviation > 0.0 ? 3 : 2);
    for (Eigen::Index k = 0; k < result.cols(); ++k) {
      Hidden other = h_;
      if (k == 0) other.bending *= 1.0 + ratio;
      if (k == 1) other.axial *= 1.0 + ratio;
      if (k == 2) other.length += longer;
      result.col(k) = read_all({}, other, highest_tension_, design_) - plain_;
    }
    return result;
  }
  /// Two steps of Gauss and Newton for the base numbers: a mount that gives moves EA by a tenth, and not
  /// linearly. Beside a length it moves it by more, and they are taken to the end.
  [[nodiscard]] double size_of(const Eigen::VectorXd& changed) const {
    const int most_steps = base_.cols() > 2 ? 40 : 2;
    Hidden fitted = h_;
    Eigen::VectorXd left = changed - plain_;
    for (int k = 0; k < most_steps; ++k) {
      const Eigen::VectorXd step = qr_.solve(places_.white(left));
      fitted.bending *= std::exp(std::clamp(ratio * step[0], -0.5, 0.5));
      fitted.axial *= std::exp(std::clamp(ratio * step[1], -0.5, 0.5));
      if (step.size() > 2) fitted.length += std::clamp(longer * step[2], -0.5 * mm, 0.5 * mm);
      left = changed - read_all({}, fitted, highest_tension_, design_);
      if (k > 1 && (base_ * step).norm() < 0.1 * sigma) break;
    }
    const Eigen::VectorXd white = places_.white(left);
    return (white - base_ * qr_.solve(white)).norm() / sigma;
  }

  const Hidden& h_;
  double highest_tension_;
  const BlindDesign& design_;
  Eigen::VectorXd plain_;
  Places places_;
  Eigen::MatrixXd base_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
};

coupling::PushProblem declared_test(const Push& p, const Hidden& h) {
  coupling::PushProblem t;
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
  return t;
}

/// Writes the experiment: declared tests with noisy readings of these forces.
void record(const Eigen::VectorXd& force, const std::vector<Push>& made, const Hidden& h,
            const BlindDesign& design, std::mt19937& noise, identification::Experiment& experiment) {
  const auto readings_a_push =
      static_cast<Eigen::Index>(force.size()) / static_cast<Eigen::Index>(made.size());
  const auto records = static_cast<int>(made.size()) * design.replicates;
  for (int number = 0; number < records; ++number) {
    const Push& p = made[static_cast<std::size_t>(number / design.replicates)];
    identification::Series series;
    series.name = fmt::format("p{}", number + 1);
    series.test = declared_test(p, h);
    identification::Readings readings;
    readings.displacement = travel_of(p, design.readings_a_leg);
    readings.time = time_of(p, design.readings_a_leg);
    const bool replicate = design.replicates > 1;
    const Deviations off = deviations_of(design.readings_a_leg, replicate, noise);
    Eigen::Index row = readings_a_push * (number / design.replicates);
    for (std::size_t i = 0; i < readings.displacement.size(); ++i, ++row)
      readings.force.push_back(force[row] * (1.0 + off.smooth[i]) + off.white[i]);
    series.test.travel = readings.displacement;
    series.readings = readings;
    if (!replicate) series.force_sigma = sigma;
    series.position_sigma = design.position_deviation;
    experiment.series.push_back(std::move(series));
  }
}

}  // namespace

BlindSet make_blind_set(const std::string& effect, double size, unsigned seed, const BlindDesign& design) {
  const std::vector<std::string> inside = effect == "none" ? std::vector<std::string>() : effects_in(effect);
  for (const std::string& one : inside) {
    if (std::ranges::find(blind_effects(), one) == blind_effects().end())
      throw std::invalid_argument("no blind effect " + one);
  }
  Hidden h = hidden_of(seed, design);
  // A uniform natural curvature does nothing between rigid clamps.
  const bool curved = std::ranges::find(inside, "natural_curvature") != inside.end();
  h.clamp_compliance = curved ? 0.5 : 0.0;
  const std::vector<Push> made = pushes_of(design);
  const double highest_tension = highest_tension_of(made, h, design);
  // Of tension, or of the buckled shape: amplitude 2 sqrt(slack / L) of the tangent, E of the strand.
  const double slack = length - pushes[0].span;
  h.highest_stress =
      std::max(highest_tension * 4.0 / (std::numbers::pi * diameter * diameter),
               0.5 * modulus * 0.5 * diameter * 4.0 * std::numbers::pi / length * std::sqrt(slack / length));
  // An effect is of one size whatever the density of its readings.
  BlindDesign sized = design;
  sized.readings_a_leg = BlindDesign{}.readings_a_leg;
  std::optional<Dosing> dosing;
  if (!inside.empty()) dosing.emplace(h, highest_tension, sized);
  BlindSet set;
  set.effect = effect;
  set.bending_stiffness = h.bending;
  set.axial_stiffness = h.axial;
  std::vector<Perturbation> doses;
  for (const std::string& one : inside) {
    const auto [dose, reached] = dosing->of(one, size);
    set.amount = doses.empty() ? dose.amount : set.amount;
    set.size = doses.empty() ? reached : std::min(set.size, reached);
    if (doses.empty()) std::tie(set.key, set.truth) = number_of(dose, h, highest_tension);
    doses.push_back(dose);
  }
  Eigen::VectorXd force = dosing ? dosing->read(doses.back()) : read_all({}, h, highest_tension, sized);
  if (doses.size() > 1 || design.readings_a_leg != sized.readings_a_leg)
    force = read_all(doses, h, highest_tension, design);
  set.experiment.file = "blind.toml";
  set.experiment.title = fmt::format("blind set {}", seed);
  set.experiment.free = {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N"};
  if (design.length_deviation > 0.0) set.experiment.free.emplace_back("wire.length_mm");
  std::mt19937 noise = noise_of(effect, inside, size, seed);
  record(force, made, h, design, noise, set.experiment);
  return set;
}

}  // namespace snare::validation
