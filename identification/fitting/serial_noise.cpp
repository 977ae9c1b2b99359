#include "identification/fitting/serial_noise.hpp"

#include "numerics/dense_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace snare::identification {

namespace {

constexpr double worthwhile = 6.0;  // of -2 log likelihood: two more numbers

/// Coordinates of the readings of a series along which correlations decay, in mean intervals.
std::vector<double> stations(const Series& series) {
  const std::size_t n = measured_displacement(series).size();
  std::vector<double> result(n);
  const bool timed = series.readings && series.readings->time.size() == n && n > 1;
  if (!timed) {
    std::iota(result.begin(), result.end(), 0.0);
    return result;
  }
  const std::vector<double>& t = series.readings->time;
  const double interval = (t.back() - t.front()) / static_cast<double>(n - 1);
  for (std::size_t i = 0; i < n; ++i) result[i] = interval > 0.0 ? (t[i] - t.front()) / interval : double(i);
  return result;
}

/// The filter of a series of which the share `smooth` of the variance is correlated; unit variance.
std::vector<Noise::Step> serial_filter(const Series& series, double smooth, double length, double sigma) {
  const std::vector<double> at = stations(series);
  const std::vector<double> height(at.size(), sigma * std::sqrt(smooth));
  return noise_filter(at, sigma * std::sqrt(1.0 - smooth), length, height);
}

}  // namespace

WhitenedRows without_correlation(const Series& series, double smooth, double length,
                                 const Eigen::MatrixXd& rows) {
  Noise one;
  one.filter.push_back(serial_filter(series, smooth, length, 1.0));
  WhitenedRows white;
  for (const Noise::Step& step : one.filter.front()) white.log_determinant -= 2.0 * std::log(step.inverse);
  white.rows = one.whiten(0, rows);
  return white;
}

namespace {

/// Residuals and derivatives of the data's series in units of sigma, one below the other.
struct SerialRows {
  std::vector<Eigen::MatrixXd> of_series;  // the residual, then the derivatives
  std::vector<const Series*> series;
  Eigen::Index readings = 0, numbers = 0;
};

SerialRows serial_rows(const Model& model, const Data& data, const Fit& fit) {
  SerialRows rows;
  for (const std::size_t k : data.series) {
    const Eigen::VectorXd r = data.measured[k] - fit.evaluation.force[k];
    Eigen::MatrixXd both(r.size(), 1);
    both.col(0) = r / data.noise.sigma[k];
    if (!fit.evaluation.by.empty()) {
      const Eigen::MatrixXd& by = fit.evaluation.by[k];
      both.conservativeResize(Eigen::NoChange, 1 + by.cols());
      both.rightCols(by.cols()) = by / data.noise.sigma[k];
    }
    rows.readings += r.size();
    rows.numbers = both.cols() - 1;
    rows.of_series.push_back(std::move(both));
    rows.series.push_back(&model.series()[k]);
  }
  return rows;
}

/// Whether sigma is known, and whether the likelihood is the restricted one, of the residual that no fitted
/// number changes.
enum class SerialLikelihood { restricted, restricted_declared, whole };

/// One point of the search.
struct GridPoint {
  double criterion = 0.0;  // -2 log of the likelihood
  double variance = 1.0;   // in units of sigma^2
};

// sigma free: (n - p) log s^2 + log|V| + log|J^T V^-1 J|; known: S + log|V| + log|J^T V^-1 J|, S = |P r|^2;
// the whole likelihood: n log s^2 + log|V|.
GridPoint likelihood_at(const SerialRows& rows, double smooth, double length, SerialLikelihood likelihood) {
  Eigen::MatrixXd all(rows.readings, 1 + rows.numbers);
  double logarithms = 0.0;
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < rows.of_series.size(); ++k) {
    const WhitenedRows white = without_correlation(*rows.series[k], smooth, length, rows.of_series[k]);
    logarithms += white.log_determinant;
    all.middleRows(row, rows.of_series[k].rows()) = white.rows;
    row += rows.of_series[k].rows();
  }
  double squares = all.col(0).squaredNorm();
  if (rows.numbers > 0) {
    const numerics::ThinSvd svd = numerics::thin_svd(all.rightCols(rows.numbers));
    for (Eigen::Index k = 0; k < rows.numbers; ++k) {
      if (!(svd.s[k] > 1e-9 * svd.s[0])) continue;
      if (likelihood != SerialLikelihood::whole) logarithms += 2.0 * std::log(svd.s[k]);
      squares -= std::pow(svd.U.col(k).dot(all.col(0)), 2);
    }
  }
  const Eigen::Index fitted = likelihood == SerialLikelihood::whole ? 0 : rows.numbers;
  const auto left = static_cast<double>(rows.readings - fitted);
  const double variance = std::max(squares, 1e-300) / left;
  const bool declared = likelihood == SerialLikelihood::restricted_declared;
  return {declared ? squares + logarithms : left * std::log(variance) + logarithms, variance};
}

/// The best of a grid of shares and lengths.
struct BestOfGrid {
  GridPoint independent, serial;
  double smooth = 0.0, length = 0.0;
};

BestOfGrid best_of_grid(const SerialRows& rows, SerialLikelihood likelihood) {
  BestOfGrid best{.independent = likelihood_at(rows, 0.0, 1.0, likelihood), .serial = {}};
  best.serial = best.independent;
  Eigen::Index longest = 0;
  for (const Eigen::MatrixXd& m : rows.of_series) longest = std::max(longest, m.rows());
  for (double length = 0.5; length <= 0.5 * static_cast<double>(longest); length *= 1.4) {
    for (const double smooth : {0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95, 0.98, 0.995, 0.9999}) {
      const GridPoint point = likelihood_at(rows, smooth, length, likelihood);
      if (point.criterion < best.serial.criterion) best = {best.independent, point, smooth, length};
    }
  }
  return best;
}

/// Number of independent readings that determine a mean as well as `n` of this correlation: n over the sum of
/// correlations.
double effective_readings(double n, double smooth, double length) {
  const double decay = std::exp(-1.0 / length);
  const double sum = 1.0 + 2.0 * smooth * decay / (1.0 - decay);
  return n / sum;
}

}  // namespace

std::optional<SerialNoise> serial_noise(const Model& model, const Data& data, const Fit& fit) {
  if (data.published() || !data.noise.published.empty() || !data.noise.filter.empty() ||
      !data.placings.empty())
    return std::nullopt;
  const SerialRows rows = serial_rows(model, data, fit);
  constexpr Eigen::Index fewest = 8;  // more than fitted numbers
  if (rows.readings < rows.numbers + fewest) return std::nullopt;
  const bool declared = data.noise.source == "declared";
  const BestOfGrid best =
      best_of_grid(rows, declared ? SerialLikelihood::restricted_declared : SerialLikelihood::restricted);
  SerialNoise found{.smooth = best.smooth, .length = best.length};
  found.evidence = best.independent.criterion - best.serial.criterion;
  if (found.evidence < worthwhile) return std::nullopt;
  const double scale = declared ? 1.0 : std::sqrt(best.serial.variance);
  found.sigma = scale * data.noise.mean_sigma(model.series());
  for (const Eigen::MatrixXd& m : rows.of_series)
    found.effective += effective_readings(static_cast<double>(m.rows()), found.smooth, found.length);
  return found;
}

double serial_criterion(const Model& model, const Data& data, const Fit& fit) {
  const SerialRows rows = serial_rows(model, data, fit);
  const BestOfGrid best = best_of_grid(rows, SerialLikelihood::whole);
  const double price = std::log(static_cast<double>(rows.readings));
  const double serial = best.serial.criterion + 2.0 * price;
  return std::min(best.independent.criterion, serial) + static_cast<double>(rows.numbers) * price;
}

Noise with_serial_part(const Model& model, const Noise& noise, const SerialNoise& serial) {
  Noise result = noise;
  const double scale = serial.sigma / noise.mean_sigma(model.series());
  result.smooth = serial.smooth;
  result.readings = serial.length;
  result.filter.clear();
  for (std::size_t k = 0; k < model.series().size(); ++k) {
    result.sigma[k] *= scale;
    result.filter.push_back(serial_filter(model.series()[k], serial.smooth, serial.length, result.sigma[k]));
  }
  return result;
}

}  // namespace snare::identification
