#include "identification/ring_down/damping_split.hpp"

#include "identification/fitting/statistics.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace snare::identification {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

constexpr Index bending_time = 0, mass_rate = 1;  // columns

/// The line of (I.10), a row a mode:  2 s_m = bending_time r_m w_m^2 + mass_rate.
struct Line {
  MatrixXd rows;        ///< r w^2 [1/s^2], 1
  VectorXd right;       ///< 2 s [1/s]
  MatrixXd covariance;  ///< of `right` [1/s^2]
};

Line line_of(const std::vector<DecayOfMode>& decays, const MatrixXd& covariance) {
  const auto n = static_cast<Index>(decays.size());
  Line line{MatrixXd::Ones(n, 2), VectorXd(n), 4.0 * covariance};
  for (Index i = 0; i < n; ++i) {
    const DecayOfMode& d = decays[static_cast<std::size_t>(i)];
    line.rows(i, bending_time) = d.bending_share * d.natural * d.natural;
    line.right[i] = 2.0 * d.decay.value;
    // Noise that vanishes, or a rate on its bound, must not weigh endlessly.
    const double least = 2e-9 * d.natural;
    line.covariance(i, i) = std::max(line.covariance(i, i), least * least);
  }
  return line;
}

/// Least squares of some of the two numbers.
struct SplitSolution {
  Vector2d value = Vector2d::Zero();
  Vector2d error = Vector2d::Zero();  ///< standard errors
  double correlation = -1.0;
  double chi2 = 0.0;
  int numbers = 0;  ///< that are fitted
};

SplitSolution least_squares(const Line& line, const VectorXd& scatter, const std::vector<Index>& columns) {
  const MatrixXd covariance = line.covariance + MatrixXd(scatter.cwiseAbs2().asDiagonal());
  const Eigen::LLT<MatrixXd> root(covariance);
  const MatrixXd rows = root.matrixL().solve(MatrixXd(line.rows(Eigen::all, columns)));
  const VectorXd right = root.matrixL().solve(line.right);
  // Columns scaled to one: the two numbers differ by the square of a frequency.
  const VectorXd scale = rows.colwise().norm();
  const MatrixXd scaled = rows * scale.cwiseInverse().asDiagonal();
  const MatrixXd inverse = (scaled.transpose() * scaled).inverse();
  const VectorXd x = inverse * (scaled.transpose() * right);
  SplitSolution solution;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto c = static_cast<Index>(k);
    solution.value[columns[k]] = x[c] / scale[c];
    solution.error[columns[k]] = std::sqrt(inverse(c, c)) / scale[c];
  }
  if (columns.size() == 2) solution.correlation = inverse(0, 1) / std::sqrt(inverse(0, 0) * inverse(1, 1));
  solution.chi2 = (right - scaled * x).squaredNorm();
  solution.numbers = static_cast<int>(columns.size());
  return solution;
}

/// The best solution without a negative number among these columns.
SplitSolution admissible(const Line& line, const VectorXd& scatter, const std::vector<Index>& columns) {
  const SplitSolution all = least_squares(line, scatter, columns);
  if (all.value.minCoeff() >= 0.0) return all;
  SplitSolution best;  // no damping
  best.chi2 = std::numeric_limits<double>::infinity();
  for (const Index one : columns) {
    const SplitSolution alone = least_squares(line, scatter, {one});
    if (alone.value[one] >= 0.0 && alone.chi2 < best.chi2) best = alone;
  }
  if (best.numbers == 0) {
    const MatrixXd covariance = line.covariance + MatrixXd(scatter.cwiseAbs2().asDiagonal());
    best.chi2 = line.right.dot(covariance.llt().solve(line.right));
  }
  return best;
}

/// Deviations of the decays that make the misfit what it is expected to be: one share, common to all, of what
/// the line gives.
VectorXd scatter_of(const Line& line, const std::vector<Index>& columns) {
  const auto n = line.right.size();
  constexpr double floor = 1e-3;  // of the largest rate: a line may give zero
  VectorXd scatter = VectorXd::Zero(n);
  double low = 1e-9, high = 1e6;  // share
  constexpr int halvings = 80, refinements = 4;
  for (int k = 0; k < halvings; ++k) {
    const double share = std::sqrt(low * high);
    SplitSolution found;
    for (int i = 0; i < refinements; ++i) {
      found = admissible(line, scatter, columns);
      scatter = share * (line.rows * found.value).cwiseMax(floor * line.right.cwiseAbs().maxCoeff());
    }
    found = admissible(line, scatter, columns);
    (found.chi2 > static_cast<double>(n - found.numbers) ? low : high) = share;
  }
  return scatter;
}

/// Half of a 95 % interval of Student's t with `dof` degrees of freedom, over that of the normal
/// distribution.
double wider_by(double dof) {
  constexpr double tail = 0.025;
  return boost::math::quantile(boost::math::complement(boost::math::students_t(dof), tail)) /
         normal_quantile(tail);
}

/// Two numbers or one of them, as far as the decays agree on them.
struct Combined {
  SplitSolution solution;
  double misfit_p = 1.0;
  int dof = 0;
};

Combined combine(const Line& line, const std::vector<Index>& columns, double least_p) {
  const auto n = static_cast<int>(line.right.size());
  const VectorXd none = VectorXd::Zero(n);
  Combined result{least_squares(line, none, columns)};
  const SplitSolution best = admissible(line, none, columns);
  result.dof = n - best.numbers;
  if (result.dof > 0) result.misfit_p = chi_square_tail(best.chi2, result.dof);
  if (result.misfit_p >= least_p) return result;
  // The share is known from as many degrees of freedom: Student's t instead of the normal quantile.
  const VectorXd scatter = scatter_of(line, columns);
  const SplitSolution widened = least_squares(line, scatter, columns);
  result.solution = admissible(line, scatter, columns);
  result.solution.error = wider_by(result.dof) * widened.error;
  result.solution.correlation = widened.correlation;
  return result;
}

/// In words: what is known of the two numbers.
std::string statement_of(const DampingSplit& split, std::size_t modes) {
  std::string text = "bending_time and mass_rate are separated";
  const auto add = [&text](const char* name, const Estimate& e) {
    if (e.upper() < 0.0) {
      text +=
          fmt::format("; {} would be negative: the decays do not follow mass_rate + bending_time w^2", name);
    } else if (e.lower() < 0.0) {
      text += fmt::format("; {} is not different from zero, at most {:.4g}", name, e.upper());
    }
  };
  add("bending_time", split.bending_time);
  add("mass_rate", split.mass_rate);
  if (!split.consistent()) {
    text += fmt::format(
        "; the {} decays do not lie on one line (P = {:.2g}): another damping is at work, or a bending_share "
        "is wrong",
        modes, split.misfit_p);
  }
  return text;
}

/// In words: decays at one frequency, which agree or do not.
std::string statement_of(const DampingSplit& split, const Line& line, double frequency) {
  if (!split.consistent()) {
    return fmt::format(
        "the decays at nearly one frequency ({:.4g} Hz) contradict each other: 2 s from {:.4g} to {:.4g} 1/s "
        "(P = {:.2g}). Loss in the material and mass-proportional damping are the same for all of them; "
        "mounts and the "
        "direction of the vibration are not",
        frequency, line.right.minCoeff(), line.right.maxCoeff(), split.misfit_p);
  }
  return fmt::format(
      "all decays are at nearly one frequency ({:.4g} Hz): known is mass_rate + bending_time w^2 = {:.4g} "
      "1/s, its "
      "split is not; all material would be bending_time_s = {:.4g}, all mass-proportional mass_rate_1_s = "
      "{:.4g}. A "
      "second mode, or the same wire at another span, separates them",
      frequency, split.mass_rate.value, split.bending_time.value, split.mass_rate.value);
}

/// Frequency of the decay that is known best, relative to r w^2 [Hz].
double surest_frequency(const Line& line, const std::vector<DecayOfMode>& decays) {
  Index surest = 0;
  line.covariance.diagonal().cwiseSqrt().cwiseQuotient(line.rows.col(bending_time)).minCoeff(&surest);
  return decays[static_cast<std::size_t>(surest)].natural / (2.0 * std::numbers::pi);
}

}  // namespace

DampingSplit split_damping(const std::vector<DecayOfMode>& decays) {
  VectorXd variances(static_cast<Index>(decays.size()));
  for (Index i = 0; i < variances.size(); ++i)
    variances[i] = std::pow(decays[static_cast<std::size_t>(i)].decay.error, 2);
  return split_damping(decays, variances.asDiagonal());
}

DampingSplit split_damping(const std::vector<DecayOfMode>& decays, const MatrixXd& covariance) {
  DampingSplit split;
  if (decays.empty()) {
    split.statement = "no mode stands out of the noise: nothing is known";
    return split;
  }
  const Line line = line_of(decays, covariance);
  constexpr double far_enough = 1.5;
  constexpr double unlikely = 0.01;
  const VectorXd squares = line.rows.col(bending_time);
  split.separated = squares.maxCoeff() >= far_enough * squares.minCoeff();
  const auto estimate = [](const Combined& c, Index k) {
    return Estimate{c.solution.value[k], c.solution.error[k]};
  };
  const Combined both = decays.size() > 1 ? combine(line, {bending_time, mass_rate}, unlikely) : Combined{};
  split.misfit_p = both.misfit_p;
  split.misfit_dof = both.dof;
  if (split.separated) {
    split.bending_time = estimate(both, bending_time);
    split.mass_rate = estimate(both, mass_rate);
    split.correlation = both.solution.correlation;
    split.statement = statement_of(split, decays.size());
  } else {
    split.bending_time = estimate(combine(line, {bending_time}, unlikely), bending_time);
    split.mass_rate = estimate(combine(line, {mass_rate}, unlikely), mass_rate);
    split.correlation = -1.0;
    split.statement = statement_of(split, line, surest_frequency(line, decays));
  }
  if (!split.consistent()) {
    split.warnings.push_back(
        fmt::format("the decays contradict mass_rate + bending_time w^2 (misfit_p {:.2g}): the intervals of "
                    "bending_time_s and mass_rate_1_s "
                    "contain their scatter, and neither number describes a single record",
                    split.misfit_p));
  }
  return split;
}

}  // namespace snare::identification
