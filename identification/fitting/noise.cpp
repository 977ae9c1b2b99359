#include "identification/fitting/noise.hpp"

#include "identification/fitting/prediction.hpp"
#include "identification/fitting/replicate_scatter.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

double range_of_forces(const std::vector<Series>& series) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const Series& s : series) {
    for (const double f : measured_force(s)) {
      low = std::min(low, f);
      high = std::max(high, f);
    }
  }
  return high - low;
}

/// Published fits among the series, with the standard deviations that they declare, or with that about
/// parabolas.
void add_published(const std::vector<Series>& series, Noise& noise) {
  const std::vector<PublishedSeries> published = published_series(series);
  if (published.empty()) return;
  noise.published.resize(series.size());
  const double common = scatter_about_parabolas(published);
  for (const PublishedSeries& one : published) {
    noise.published[one.index].emplace(one);
    noise.set_published_sigma(one.index, one.sigma.value_or(common));
  }
  noise.estimated = estimated_scatters(published, noise.scatter);
}

}  // namespace

// The smooth part is h_i x_i, x of unit variance with x_i = decay_i x_{i-1} + noise (Ornstein and Uhlenbeck):
// a Kalman filter's innovations over their deviations are the whitened values, in order and linear in them.
//   P = decay^2 P+ + 1 - decay^2,  S = h^2 P + w^2,  gain = P h / S,  P+ = (1 - gain h) P
std::vector<Noise::Step> noise_filter(const std::vector<double>& d, double white, double length,
                                      const std::vector<double>& height) {
  std::vector<Noise::Step> filter(d.size());
  double after = 1.0;
  for (std::size_t i = 0; i < d.size(); ++i) {
    Noise::Step& step = filter[i];
    step.decay = i == 0 ? 1.0 : std::exp(-std::abs(d[i] - d[i - 1]) / length);
    step.height = height[i];
    const double before = step.decay * step.decay * after + 1.0 - step.decay * step.decay;
    const double variance = step.height * step.height * before + white * white;
    step.gain = before * step.height / variance;
    step.inverse = 1.0 / std::sqrt(variance);
    after = (1.0 - step.gain * step.height) * before;
  }
  return filter;
}

void Noise::set_published_sigma(std::size_t series, double of_series) {
  sigma[series] = of_series;
  published[series]->set_sigma(of_series);
}

Eigen::MatrixXd Noise::whiten(std::size_t series, const Eigen::MatrixXd& values) const {
  if (summarised(series)) return published[series]->whiten(values);
  if (filter.empty()) return values / sigma[series];
  const std::vector<Step>& steps = filter[series];
  Eigen::MatrixXd result(values.rows(), values.cols());
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    double state = 0.0;
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      const Step& step = steps[static_cast<std::size_t>(i)];
      state *= step.decay;
      const double innovation = values(i, column) - step.height * state;
      result(i, column) = innovation * step.inverse;
      state += step.gain * innovation;
    }
  }
  return result;
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

Noise declared_noise(const std::vector<Series>& series, PublishedScatter scatter) {
  Noise noise;
  noise.scatter = scatter;
  const bool declared =
      std::all_of(series.begin(), series.end(), [](const Series& s) { return s.force_sigma || s.law; });
  if (!declared || series.empty()) return noise;
  noise.source = "declared";
  for (const Series& s : series) noise.sigma.push_back(s.force_sigma.value_or(0.0));
  add_published(series, noise);
  return noise;
}

namespace {

Noise noise_of_readings(const std::vector<Series>& series, const std::vector<Eigen::VectorXd>& residuals,
                        const std::vector<Eigen::VectorXd>& computed) {
  const double least = 1e-9 * range_of_forces(series);
  const Roughness roughness = roughness_of(residuals);
  Noise noise;
  const std::optional<ReplicateScatter> scatter = replicate_scatter(series, residuals, computed, roughness);
  if (!scatter) {
    noise.source = "residual";
    noise.dof = std::max(1.0, roughness.dof);
    noise.sigma.assign(series.size(), std::max(std::sqrt(roughness.variance), least));
    return noise;
  }
  noise.source = "replicates";
  noise.dof = scatter->dof;
  const double white = std::max(scatter->white, least);
  double independent = 0.0;
  double all = 0.0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const std::vector<double> height = scatter->heights(computed[k]);
    double squares = 0.0;
    for (const double h : height) squares += h * h;
    const double smooth = squares / static_cast<double>(std::max<std::size_t>(1, height.size()));
    noise.sigma.push_back(std::sqrt(white * white + smooth));
    independent += white * white;
    all += white * white + smooth;
    if (scatter->length > 0.0)
      noise.filter.push_back(noise_filter(measured_displacement(series[k]), white, scatter->length, height));
  }
  noise.length = scatter->length;
  noise.smooth = 1.0 - independent / all;
  return noise;
}

}  // namespace

Noise noise_from_residuals(const std::vector<Series>& series, const std::vector<Eigen::VectorXd>& residuals,
                           const std::vector<Eigen::VectorXd>& computed) {
  // Published fits say themselves how their readings scatter.
  std::vector<Series> read;
  std::vector<Eigen::VectorXd> left, forces;
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (series[k].law) continue;
    read.push_back(series[k]);
    left.push_back(residuals[k]);
    forces.push_back(computed[k]);
  }
  Noise noise = noise_of_readings(read, left, forces);
  if (read.size() == series.size()) return noise;
  Noise all = noise;
  all.sigma.clear();
  all.filter.clear();
  std::size_t at = 0;
  for (const Series& s : series) {
    all.sigma.push_back(s.law ? 0.0 : noise.sigma[at]);
    if (!noise.filter.empty()) all.filter.push_back(s.law ? std::vector<Noise::Step>() : noise.filter[at]);
    if (!s.law) ++at;
  }
  add_published(series, all);
  return all;
}

}  // namespace snare::identification
