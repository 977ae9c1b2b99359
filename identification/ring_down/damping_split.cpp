#include "identification/ring_down/damping_split.hpp"

#include "identification/fitting/statistics.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace snare::identification {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index bending_time = 0, mass_rate = 1;  // columns

/// The line of (I.10), a row a mode, over the standard error of its decay:
///   2 s_m = bending_time r_m w_m^2 + mass_rate
struct Line {
  MatrixXd rows;
  VectorXd right;
  double low = std::numeric_limits<double>::infinity();  ///< least and largest r w^2 [1/s^2]
  double high = 0.0;
  std::size_t surest = 0;  ///< mode of the least relative error
};

Line line_of(const std::vector<DecayOfMode>& decays) {
  const auto n = static_cast<Index>(decays.size());
  Line line;
  line.rows.resize(n, 2);
  line.right.resize(n);
  double best = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < n; ++i) {
    const DecayOfMode& d = decays[static_cast<std::size_t>(i)];
    const double square = d.bending_share * d.natural * d.natural;
    // Noise that vanishes, or a rate on its bound, must not weigh endlessly.
    const double error = 2.0 * std::max(d.decay.error, 1e-9 * d.natural);
    line.rows(i, bending_time) = square / error;
    line.rows(i, mass_rate) = 1.0 / error;
    line.right[i] = 2.0 * d.decay.value / error;
    line.low = std::min(line.low, square);
    line.high = std::max(line.high, square);
    if (error / square < best) {
      best = error / square;
      line.surest = static_cast<std::size_t>(i);
    }
  }
  return line;
}

/// All decays at nearly one r w^2: each number as if it were alone.
DampingSplit not_separated(const Line& line, const std::vector<DecayOfMode>& decays) {
  DampingSplit split;
  const auto alone = [&line](Index k) -> Estimate {
    const VectorXd column = line.rows.col(k);
    return {column.dot(line.right) / column.squaredNorm(), 1.0 / column.norm()};
  };
  split.bending_time = alone(bending_time);
  split.mass_rate = alone(mass_rate);
  split.correlation = -1.0;
  split.statement = fmt::format(
      "all decays are at nearly one frequency ({:.4g} Hz): known is mass_rate + bending_time w^2 = {:.4g} 1/s, its "
      "split is not; all material would be bending_time_s = {:.4g}, all mass-proportional mass_rate_1_s = {:.4g}. A "
      "second mode, or the same wire at another span, separates them",
      decays[line.surest].natural / (2.0 * std::numbers::pi), split.mass_rate.value, split.bending_time.value,
      split.mass_rate.value);
  return split;
}

/// In words: what is known of the two numbers.
std::string statement_of(const DampingSplit& split, std::size_t modes) {
  std::string text = "bending_time and mass_rate are separated";
  const auto add = [&text](const char* name, const Estimate& e) {
    if (e.upper() < 0.0) {
      text += fmt::format("; {} would be negative: the decays do not follow mass_rate + bending_time w^2", name);
    } else if (e.lower() < 0.0) {
      text += fmt::format("; {} is not different from zero, at most {:.4g}", name, e.upper());
    }
  };
  add("bending_time", split.bending_time);
  add("mass_rate", split.mass_rate);
  constexpr double unlikely = 0.01;
  if (split.misfit_p < unlikely) {
    text += fmt::format(
        "; the {} decays do not lie on one line (P = {:.2g}): another damping is at work, or a bending_share is wrong",
        modes, split.misfit_p);
  }
  return text;
}

}  // namespace

DampingSplit split_damping(const std::vector<DecayOfMode>& decays) {
  if (decays.empty()) {
    DampingSplit split;
    split.statement = "no mode stands out of the noise: nothing is known";
    return split;
  }
  const Line line = line_of(decays);
  constexpr double far_enough = 1.5;
  if (line.high < far_enough * line.low) return not_separated(line, decays);

  // Weighted least squares of two numbers.
  DampingSplit split;
  split.separated = true;
  const Eigen::Matrix2d covariance = (line.rows.transpose() * line.rows).inverse();
  const Eigen::Vector2d x = covariance * (line.rows.transpose() * line.right);
  const Eigen::Vector2d error = covariance.diagonal().cwiseSqrt();
  split.correlation = covariance(bending_time, mass_rate) / (error[bending_time] * error[mass_rate]);
  const double chi2 = (line.right - line.rows * x).squaredNorm();
  if (decays.size() > 2) split.misfit_p = chi_square_tail(chi2, static_cast<double>(decays.size() - 2));
  split.bending_time = {x[bending_time], error[bending_time]};
  split.mass_rate = {x[mass_rate], error[mass_rate]};
  split.statement = statement_of(split, decays.size());
  return split;
}

}  // namespace snare::identification
