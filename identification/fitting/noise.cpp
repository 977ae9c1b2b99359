#include "identification/fitting/noise.hpp"

#include "identification/fitting/prediction.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::identification {

namespace {

bool same_test(const coupling::PushProblem& a, const coupling::PushProblem& b) {
  return a.contact_position == b.contact_position && a.mount.kind == b.mount.kind && a.mount.span == b.mount.span &&
         a.mount.support_radius == b.mount.support_radius && a.wire.length == b.wire.length &&
         a.wire.diameter == b.wire.diameter && a.wire.bending_stiffness() == b.wire.bending_stiffness() &&
         a.wire.axial_stiffness() == b.wire.axial_stiffness() && a.pusher.radius == b.pusher.radius &&
         a.pusher.direction == b.pusher.direction && a.pusher.friction == b.pusher.friction;
}

double highest(const std::vector<double>& d) {
  return *std::max_element(d.begin(), d.end());
}

/// Force of a record at a displacement of its first loading, by straight lines; the path's first pass counts.
double force_at(const Readings& r, double displacement) {
  for (std::size_t i = 1; i < r.displacement.size(); ++i) {
    const double a = r.displacement[i - 1];
    const double b = r.displacement[i];
    if (b > a && a <= displacement && displacement <= b) {
      return r.force[i - 1] + (r.force[i] - r.force[i - 1]) * (displacement - a) / (b - a);
    }
  }
  return r.force.back();
}

constexpr int common_points = 200;  // displacements of the loading at which replicates are compared

/// Deviations of replicates from their mean at common displacements of the loading.
struct Scatter {
  double squares = 0.0;                                                    ///< sum [N^2]
  double count = 0.0;                                                      ///< degrees of freedom
  double longest = 0.0;                                                    ///< range of the displacements [m]
  std::vector<double> products = std::vector<double>(common_points, 0.0);  ///< of deviations this many points apart
};

void add_scatter(const std::vector<Series>& series, const std::vector<std::size_t>& group, Scatter& scatter) {
  double range = 1e300;
  for (const std::size_t k : group) range = std::min(range, highest(series[k].readings->displacement));
  scatter.longest = std::max(scatter.longest, range);
  std::vector<std::vector<double>> deviations(group.size());
  for (int i = 0; i < common_points; ++i) {
    const double d = range * (0.02 + 0.96 * i / (common_points - 1));
    double mean = 0.0;
    for (std::size_t j = 0; j < group.size(); ++j) {
      deviations[j].push_back(force_at(*series[group[j]].readings, d));
      mean += deviations[j].back() / static_cast<double>(group.size());
    }
    for (std::vector<double>& one : deviations) {
      one.back() -= mean;
      scatter.squares += one.back() * one.back();
    }
    scatter.count += static_cast<double>(group.size() - 1);
  }
  for (const std::vector<double>& one : deviations) {
    for (std::size_t lag = 1; lag < one.size(); ++lag) {
      for (std::size_t i = lag; i < one.size(); ++i) {
        scatter.products[lag] += one[i] * one[i - lag] / static_cast<double>(one.size() - lag) * common_points;
      }
    }
  }
}

/// Variance of the independent part from second differences, mean (f_{i-1} - 2 f_i + f_{i+1})^2 / 6, at most
/// `all`.
double white_variance(const std::vector<Series>& series, double all) {
  double white = 0.0;
  double bends = 0.0;
  for (const Series& s : series) {
    const std::vector<double>& f = s.readings->force;
    for (std::size_t i = 1; i + 1 < f.size(); ++i) {
      white += std::pow(f[i - 1] - 2.0 * f[i] + f[i + 1], 2) / 6.0;
      bends += 1.0;
    }
  }
  return bends > 0.0 ? std::min(white / bends, all) : all;
}

/// Cholesky factor of  variance ((1 - smooth) I + smooth exp(-|path_i - path_j| / length)).   theory.md (I.3)
Eigen::MatrixXd covariance_factor(const Series& series, double variance, double smooth, double length) {
  const std::vector<double>& d = measured_displacement(series);
  const auto n = static_cast<Eigen::Index>(d.size());
  Eigen::VectorXd path = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 1; i < n; ++i) {
    path[i] = path[i - 1] + std::abs(d[static_cast<std::size_t>(i)] - d[static_cast<std::size_t>(i - 1)]);
  }
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      covariance(i, j) = variance * smooth * std::exp(-std::abs(path[i] - path[j]) / length);
    }
    covariance(i, i) += variance * (1.0 - smooth);
  }
  return covariance.llt().matrixL();
}

}  // namespace

Eigen::MatrixXd Noise::whiten(std::size_t series, const Eigen::MatrixXd& values) const {
  if (factor.empty()) return values / sigma[series];
  return factor[series].triangularView<Eigen::Lower>().solve(values);
}

double Noise::mean_sigma(const std::vector<Series>& series) const {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const auto n = static_cast<double>(measured_displacement(series[k]).size());
    sum += n * sigma[k] * sigma[k];
    count += n;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

std::vector<std::vector<std::size_t>> replicates(const std::vector<Series>& series) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (!series[k].readings) continue;
    bool placed = false;
    for (std::vector<std::size_t>& group : groups) {
      if (!same_test(series[group.front()].test, series[k].test)) continue;
      group.push_back(k);
      placed = true;
      break;
    }
    if (!placed) groups.push_back({k});
  }
  std::erase_if(groups, [](const std::vector<std::size_t>& g) { return g.size() < 2; });
  return groups;
}

Noise known_noise(const std::vector<Series>& series) {
  Noise noise;
  const bool declared =
      std::all_of(series.begin(), series.end(), [](const Series& s) { return s.force_sigma || s.law; });
  if (declared && !series.empty()) {
    noise.source = "declared";
    for (const Series& s : series) noise.sigma.push_back(s.force_sigma ? *s.force_sigma : s.law->scatter());
    return noise;
  }
  Scatter scatter;
  for (const std::vector<std::size_t>& group : replicates(series)) add_scatter(series, group, scatter);
  if (scatter.count == 0.0 || scatter.squares == 0.0) return noise;
  noise.source = "replicates";
  const double variance = scatter.squares / scatter.count;
  noise.sigma.assign(series.size(), std::sqrt(variance));
  // What is not independent is smooth; dense records count as independent.
  std::size_t most = 0;
  for (const Series& s : series) most = std::max(most, s.readings->force.size());
  noise.smooth = std::clamp(1.0 - white_variance(series, variance) / variance, 0.0, 0.9999);
  if (noise.smooth < 0.02 || most > 2000) {
    noise.smooth = 0.0;
    return noise;
  }
  // Its length: where the correlation has fallen to 1/e.
  const std::vector<double>& products = scatter.products;
  std::size_t lag = 1;
  while (lag + 1 < products.size() / 2 && products[lag] > products[1] / std::numbers::e) ++lag;
  noise.length = scatter.longest * 0.96 * static_cast<double>(lag) / (common_points - 1);
  for (const Series& s : series) noise.factor.push_back(covariance_factor(s, variance, noise.smooth, noise.length));
  return noise;
}

Noise noise_from_residuals(const std::vector<Series>& series, const std::vector<Eigen::VectorXd>& residuals) {
  double sum = 0.0;
  double count = 0.0;
  double low = 1e300;
  double high = -1e300;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const Eigen::VectorXd& r = residuals[k];
    for (Eigen::Index i = 1; i + 1 < r.size(); ++i) {
      const double bend = r[i - 1] - 2.0 * r[i] + r[i + 1];
      sum += bend * bend / 6.0;
      count += 1.0;
    }
    for (const double f : measured_force(series[k])) {
      low = std::min(low, f);
      high = std::max(high, f);
    }
  }
  Noise noise;
  noise.source = "residual";
  const double sigma = count > 0.0 ? std::sqrt(sum / count) : 0.0;
  noise.sigma.assign(series.size(), std::max(sigma, 1e-9 * (high - low)));
  return noise;
}

}  // namespace snare::identification
