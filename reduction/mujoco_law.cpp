#include "reduction/mujoco_law.hpp"

#include <algorithm>
#include <cmath>

namespace snare::reduction {

namespace {

using Eigen::Vector3d;

constexpr double default_step = 2e-3;   // of MuJoCo [s]
constexpr double accurate_angle = 0.2;  // omega h
constexpr int slider_count = 10;
constexpr double most_yield = 1.0 / 40.0;  // of the travel

/// Sum of truncated cubics that is the curve: at every knot its second and third derivatives change, beyond
/// the last one it is straight.
std::vector<MujocoSpring> springs_of(const numerics::HermiteCurve& curve) {
  const std::vector<double>& x = curve.knots();
  const std::vector<double>& m = curve.slopes();
  std::vector<MujocoSpring> springs;
  double second = 0.0, third = 0.0;  // c and e of F = v + m u + c u^2 + e u^3 in the cell before, at its end
  const double scale = std::max(std::abs(curve.value(x.back())), 1e-300);
  for (std::size_t i = 0; i < x.size(); ++i) {
    Vector3d jump;
    double c = 0.0, e = 0.0, h = 0.0;
    if (i + 1 < x.size()) {
      h = x[i + 1] - x[i];
      const double secant = (curve.value(x[i + 1]) - curve.value(x[i])) / h;
      c = (3.0 * secant - 2.0 * m[i] - m[i + 1]) / h;
      e = (m[i] + m[i + 1] - 2.0 * secant) / (h * h);
      jump = {i == 0 ? m[0] : 0.0, c - second, e - third};
    } else {
      jump = {std::max(0.0, m[i]) - m[i], -second, -third};
    }
    second = c + 3.0 * e * h;
    third = e;
    double power = x.back(), largest = 0.0;
    for (double& k : jump) {
      if (std::abs(k) * power <= 1e-13 * scale) k = 0.0;  // a rounding of the table's numbers
      largest = std::max(largest, std::abs(k));
      power *= x.back();
    }
    if (largest > 0.0) springs.push_back({x[i], jump});
  }
  return springs;
}

/// dF/dd of springs [N/m].
double stiffness_of(const std::vector<MujocoSpring>& springs, double travel) {
  double sum = 0.0;
  for (const MujocoSpring& s : springs) {
    const double u = travel - s.start;
    if (u > 0.0) sum += s.stiffness[0] + u * (2.0 * s.stiffness[1] + 3.0 * u * s.stiffness[2]);
  }
  return sum;
}

/// ds/dd of a slider's tendon [-]: twice the sine of the angle of its straight parts.
double lever(const MujocoSlider& slider, double travel) {
  const double u = travel - slider.start;
  if (!(u > 0.0)) return 0.0;
  const double r = mujoco_pin_share * slider.half_width;
  const double distance = std::hypot(slider.half_width, u - r);
  return 2.0 * std::sin(std::atan2(slider.half_width, r - u) - std::acos(r / distance));
}

/// Least squares |A x - b| with x >= 0, by coordinate descent; few unknowns.
Eigen::VectorXd non_negative(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  const Eigen::MatrixXd normal = A.transpose() * A;
  const Eigen::VectorXd right = A.transpose() * b;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(A.cols());
  for (int sweep = 0; sweep < 5000; ++sweep) {
    double moved = 0.0;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      const double was = x[k];
      x[k] = std::max(0.0, was + (right[k] - normal.row(k).dot(x)) / normal(k, k));
      moved = std::max(moved, std::abs(x[k] - was));
    }
    if (moved <= 1e-12 * x.maxCoeff()) break;
  }
  return x;
}

/// Steady cycle 0, end, 0 of the sliders: forces on both branches and the energy lost.
struct Cycle {
  std::vector<double> travel, up, down;
  double energy = 0.0;
};
Cycle cycle_of(const std::vector<MujocoSlider>& sliders, double end) {
  constexpr int steps = 4000;
  Cycle cycle;
  cycle.travel.resize(steps + 1);
  cycle.up.assign(steps + 1, 0.0);
  cycle.down.assign(steps + 1, 0.0);
  for (int i = 0; i <= steps; ++i) cycle.travel[static_cast<std::size_t>(i)] = end * i / steps;
  for (const MujocoSlider& s : sliders) {
    double slipped = 0.0;
    const auto force = [&](double d) {
      const double stretch = elongation(s, d);
      slipped = std::clamp(slipped, stretch - s.yield, stretch + s.yield);
      return s.tension / s.yield * (stretch - slipped) * lever(s, d);
    };
    for (int round = 0; round < 2; ++round) {
      for (int i = 0; i <= steps; ++i)
        cycle.up[static_cast<std::size_t>(i)] += (round == 1) * force(end * i / steps);
      for (int i = steps; i >= 0; --i)
        cycle.down[static_cast<std::size_t>(i)] += (round == 1) * force(end * i / steps);
    }
  }
  for (std::size_t i = 0; i < steps; ++i)
    cycle.energy += 0.5 * (cycle.up[i] + cycle.up[i + 1] - cycle.down[i] - cycle.down[i + 1]) * end / steps;
  return cycle;
}

/// Sliders whose forces are (1 - r)/2 of the loading curve on the way in, the opposite on the way back, and
/// lose the loop's energy.
std::optional<MujocoLoop> loop_of(const numerics::HermiteCurve& curve,
                                  const std::vector<MujocoSpring>& springs,
                                  const scenario::DistilledLoss::Loop& law) {
  const double end = curve.knots().back();
  const double half = 0.5 * (1.0 - law.returned);
  if (!(law.energy > 0.0 && half > 0.0 && law.turn > 0.0)) return std::nullopt;
  constexpr int points = 400;
  Eigen::MatrixXd levers(points, slider_count);
  Eigen::VectorXd wanted(points);
  MujocoLoop loop;
  for (int k = 0; k < slider_count; ++k)
    loop.sliders.push_back(
        {end * k / slider_count, 0.5 * end / slider_count, 0.0, std::min(law.turn, most_yield * end)});
  for (int i = 0; i < points; ++i) {
    const double d = end * (i + 1) / points;
    wanted[i] = half * curve.value(d);
    for (int k = 0; k < slider_count; ++k) levers(i, k) = lever(loop.sliders[static_cast<std::size_t>(k)], d);
  }
  const Eigen::VectorXd tensions = non_negative(levers, wanted);
  for (int k = 0; k < slider_count; ++k) loop.sliders[static_cast<std::size_t>(k)].tension = tensions[k];
  std::erase_if(loop.sliders,
                [&](const MujocoSlider& s) { return !(s.tension > 1e-9 * tensions.maxCoeff()); });
  const double lost = cycle_of(loop.sliders, end).energy;
  if (!(lost > 0.0)) return std::nullopt;
  for (MujocoSlider& s : loop.sliders) s.tension *= law.energy / lost;
  const Cycle cycle = cycle_of(loop.sliders, end);
  loop.energy = cycle.energy;
  loop.springs = springs;
  for (MujocoSpring& s : loop.springs) s.stiffness *= 0.5 * (1.0 + law.returned);
  for (std::size_t i = 0; i < cycle.travel.size(); ++i) {
    const double d = cycle.travel[i];
    const double middle = 0.5 * (1.0 + law.returned) * curve.value(d);
    loop.largest_error = std::max(loop.largest_error, std::abs(middle + cycle.up[i] - curve.value(d)));
    if (d < end - law.turn)
      loop.largest_error =
          std::max(loop.largest_error, std::abs(middle + cycle.down[i] - law.returned * curve.value(d)));
  }
  return loop;
}

}  // namespace

double force_of(const std::vector<MujocoSpring>& springs, double travel) {
  double sum = 0.0;
  for (const MujocoSpring& s : springs) {
    const double u = travel - s.start;
    if (u > 0.0) sum += u * (s.stiffness[0] + u * (s.stiffness[1] + u * s.stiffness[2]));
  }
  return sum;
}

double elongation(const MujocoSlider& slider, double travel) {
  const double u = travel - slider.start;
  if (!(u > 0.0)) return 0.0;
  const double r = mujoco_pin_share * slider.half_width;
  const double distance = std::hypot(slider.half_width, u - r);
  const double angle = std::atan2(slider.half_width, r - u) - std::acos(r / distance);
  return 2.0 * (std::sqrt(distance * distance - r * r) + r * angle - slider.half_width);
}

double sufficient_mass(const MujocoLaw& law) {
  return law.steepest * default_step * default_step / (accurate_angle * accurate_angle);
}

MujocoLaw mujoco_law(double position, const numerics::HermiteCurve& curve, std::optional<double> linear,
                     const scenario::DistilledLoss& loss) {
  MujocoLaw law;
  law.position = position;
  law.end = curve.knots().back();
  law.force_range = curve.value(law.end);
  law.springs = springs_of(curve);
  constexpr int points = 800;
  double work = 0.0, square = 0.0;
  for (int i = 1; i <= points; ++i) {
    const double d = law.end * i / points;
    work += d * curve.value(d);
    square += d * d;
    law.steepest =
        std::max({law.steepest, stiffness_of(law.springs, d), stiffness_of(law.springs, law.end + d)});
  }
  law.linear_stiffness = std::max(0.0, linear.value_or(work / square));
  for (int i = 1; i <= points; ++i) {
    const double d = law.end * i / points;
    law.linear_error = std::max(law.linear_error, std::abs(law.linear_stiffness * d - curve.value(d)));
  }
  law.dashpot = loss.dashpot;
  if (loss.loop) law.loop = loop_of(curve, law.springs, *loss.loop);
  return law;
}

}  // namespace snare::reduction
