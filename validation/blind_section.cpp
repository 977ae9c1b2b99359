#include "validation/blind_section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::validation::blind {
namespace {

constexpr double kHardening = 0.02;
constexpr double kRamp = 1e-3;  // width of a damage's edge [m]

// C1 step from 0 to 1 about x = 0, and its slope.
std::array<double, 2> ramp(double x) {
  const double u = std::clamp(x / kRamp + 0.5, 0.0, 1.0);
  return {u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) / kRamp};
}

// Of equal shares, at the middles of equal parts of the logarithms' range.
std::vector<double> slip_curvatures(const BlindWire& wire) {
  if (!(wire.strand_slip_breadth > 0.0)) return {wire.strand_slip_curvature};
  std::vector<double> result;
  const int n = wire.strand_layers;
  for (int i = 0; i < n; ++i) {
    const double at = (2.0 * i + 1.0) / n - 1.0;
    result.push_back(wire.strand_slip_curvature * std::exp(wire.strand_slip_breadth * at));
  }
  return result;
}

}  // namespace

Section::Section(const BlindWire& wire)
    : bending_(wire.bending_stiffness),
      axial_(wire.axial_stiffness),
      natural_(wire.natural_curvature),
      damage_from_(wire.damage_from),
      damage_to_(wire.damage_to),
      damage_(wire.damage_factor),
      extra_(wire.strand_extra_stiffness),
      slip_(slip_curvatures(wire)),
      strands_(extra_ > 0.0 && wire.strand_slip_curvature > 0.0),
      yields_(std::isfinite(wire.yield_stress)),
      viscous_(wire.relaxation_time > 0.0) {
  if (!remembers()) return;
  // Wire that a slipping mount feeds in comes from S < 0.
  begin_ = std::isfinite(wire.mount_slip_tension) ? -0.1 * wire.length : 0.0;
  count_ = static_cast<std::size_t>(wire.history_points);
  step_ = (wire.length - begin_) / static_cast<double>(count_ - 1);
  if (strands_) strand_.assign(slip_.size(), std::vector<double>(count_, 0.0));
  if (viscous_) {
    curvature_.assign(count_, 0.0);
    strain_.assign(count_, 0.0);
  }
  if (!yields_) return;
  plastic_.assign(count_, {});
  axial_plastic_.assign(count_, 0.0);
  const double half = 0.5 * wire.diameter;
  const double thickness = half / static_cast<double>(kFibres);
  double second_moment = 0.0;
  for (std::size_t i = 0; i < kFibres; ++i) {
    height_[i] = (static_cast<double>(i) + 0.5) * thickness;
    area_[i] = 4.0 * std::sqrt(half * half - height_[i] * height_[i]) * thickness;
    second_moment += area_[i] * height_[i] * height_[i];
  }
  modulus_ = (1.0 - kHardening) * bending_ / second_moment;
  limit_ = (1.0 - kHardening) * wire.yield_stress;
  axial_limit_ = limit_ * std::numbers::pi * half * half;
}

std::array<double, 2> Section::stiffness(double S) const {
  if (damage_ == 1.0) return {bending_, 0.0};
  const auto up = ramp(S - damage_from_);
  const auto down = ramp(S - damage_to_);
  const double change = bending_ * (damage_ - 1.0);
  return {bending_ + change * (up[0] - down[0]), change * (up[1] - down[1])};
}

Section::Place Section::find(double S) const {
  const double u = std::clamp((S - begin_) / step_, 0.0, static_cast<double>(count_ - 1));
  const std::size_t j = std::min(static_cast<std::size_t>(u), count_ - 2);
  return {j, u - static_cast<double>(j)};
}

std::array<double, 2> Section::at(const std::vector<double>& field, Place p) const {
  const double change = field[p.j + 1] - field[p.j];
  return {field[p.j] + p.part * change, change / step_};
}

// Without fibres: M = B (kappa + kappa_nat) + B rate (kappa - kappa_old) + m with m a clamped spring.
Response Section::bend(double M, double S, double rate, double guess) const {
  if (yields_ || slip_.size() > 1) return bend_fibres(M, S, rate, guess);
  const auto [B, B_slope] = stiffness(S);
  double slope = B;
  double load = M - B * natural_;
  double load_slope = -B_slope * natural_;
  double slope_slope = B_slope;
  if (!remembers()) {
    const double kappa = load / slope;
    return {kappa, 1.0 / slope, (load_slope - kappa * slope_slope) / slope};
  }
  const Place p = find(S);
  if (viscous_) {
    const auto old = at(curvature_, p);
    slope += rate * B;
    slope_slope += rate * B_slope;
    load += rate * B * old[0];
    load_slope += rate * (B_slope * old[0] + B * old[1]);
  }
  if (strands_) {
    const auto centre = at(strand_.front(), p);
    const double held = (load + extra_ * centre[0]) / (slope + extra_);
    if (std::abs(held - centre[0]) <= slip_.front()) {
      slope += extra_;
      load += extra_ * centre[0];
      load_slope += extra_ * centre[1];
    } else {
      load -= std::copysign(extra_ * slip_.front(), held - centre[0]);
    }
  }
  const double kappa = load / slope;
  return {kappa, 1.0 / slope, (load_slope - kappa * slope_slope) / slope};
}

// Piecewise linear and increasing in kappa: Newton, kept inside the bracket found so far.
Response Section::bend_fibres(double M, double S, double rate, double guess) const {
  const auto [B, B_slope] = stiffness(S);
  const double factor = B / bending_;
  const Place p = find(S);
  std::array<double, kFibres> centre{};
  std::array<double, kFibres> centre_slope{};
  for (std::size_t i = 0; i < kFibres && yields_; ++i) {
    const double change = plastic_[p.j + 1][i] - plastic_[p.j][i];
    centre[i] = plastic_[p.j][i] + p.part * change;
    centre_slope[i] = change / step_;
  }
  std::vector<std::array<double, 2>> strand;
  std::array<double, 2> old{0.0, 0.0};
  for (const std::vector<double>& layer : strand_) strand.push_back(at(layer, p));
  const double share = extra_ / static_cast<double>(slip_.size());
  if (viscous_) old = at(curvature_, p);
  const double viscous = viscous_ ? rate : 0.0;

  double kappa = guess;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double tangent = B;
  double by_S = 0.0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double turned = kappa + natural_;
    double section = (yields_ ? kHardening : 1.0) * bending_ * turned;
    double section_tangent = (yields_ ? kHardening : 1.0) * bending_;
    double memory_slope = 0.0;
    for (std::size_t i = 0; i < kFibres && yields_; ++i) {
      const double stress = modulus_ * (height_[i] * turned - centre[i]);
      const double bounded = std::clamp(stress, -limit_, limit_);
      section += height_[i] * area_[i] * bounded;
      if (bounded == stress) {
        section_tangent += height_[i] * height_[i] * area_[i] * modulus_;
        memory_slope -= height_[i] * area_[i] * modulus_ * centre_slope[i];
      }
    }
    double moment = factor * section + viscous * B * (kappa - old[0]);
    tangent = factor * section_tangent + viscous * B;
    by_S = B_slope / bending_ * section + factor * memory_slope +
           viscous * (B_slope * (kappa - old[0]) - B * old[1]);
    for (std::size_t j = 0; j < strand.size(); ++j) {
      const double arm = kappa - strand[j][0];
      moment += share * std::clamp(arm, -slip_[j], slip_[j]);
      if (std::abs(arm) <= slip_[j]) {
        tangent += share;
        by_S -= share * strand[j][1];
      }
    }
    const double excess = moment - M;
    (excess > 0.0 ? high : low) = kappa;
    const double step = excess / tangent;
    if (std::abs(step) <= 1e-13 * (1.0 + std::abs(kappa))) break;
    kappa -= step;
    if (kappa <= low || kappa >= high) kappa = 0.5 * (low + high);
  }
  return {kappa, 1.0 / tangent, -by_S / tangent};
}

// N = EA e + EA rate (e - e_old), the elastic part split into h and the plastic 1 - h where the wire can
// yield.
Response Section::stretch(double N, double S, double rate) const {
  if (!yields_ && !viscous_) return {N / axial_, 1.0 / axial_, 0.0};
  const Place p = find(S);
  double slope = axial_;
  double load = N;
  double load_slope = 0.0;
  if (viscous_) {
    const auto old = at(strain_, p);
    slope += rate * axial_;
    load += rate * axial_ * old[0];
    load_slope += rate * axial_ * old[1];
  }
  if (yields_) {
    const double share = (1.0 - kHardening) * axial_;
    const auto centre = at(axial_plastic_, p);
    const double held = (load + share * centre[0]) / slope;
    if (std::abs(share * (held - centre[0])) <= axial_limit_) {
      load += share * centre[0];
      load_slope += share * centre[1];
    } else {
      load -= std::copysign(axial_limit_, held - centre[0]);
      slope -= share;
    }
  }
  return {load / slope, 1.0 / slope, load_slope / slope};
}

void Section::remember(std::size_t j, double M, double N, double rate) {
  const double S = coordinate(j);
  const double kappa = bend(M, S, rate, viscous_ ? curvature_[j] : M / bending_).strain;
  const double strain = stretch(N, S, rate).strain;
  for (std::size_t i = 0; i < strand_.size(); ++i)
    strand_[i][j] = std::clamp(strand_[i][j], kappa - slip_[i], kappa + slip_[i]);
  if (yields_) {
    const double range = limit_ / modulus_;
    for (std::size_t i = 0; i < kFibres; ++i) {
      const double e = height_[i] * (kappa + natural_);
      plastic_[j][i] = std::clamp(plastic_[j][i], e - range, e + range);
    }
    const double axial_range = axial_limit_ / ((1.0 - kHardening) * axial_);
    axial_plastic_[j] = std::clamp(axial_plastic_[j], strain - axial_range, strain + axial_range);
  }
  if (viscous_) {
    curvature_[j] = kappa;
    strain_[j] = strain;
  }
}

}  // namespace snare::validation::blind
