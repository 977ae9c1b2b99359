#include "identification/fitting/published_fit.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace snare::identification {

namespace {

using Eigen::Index;
using Point = PublishedDeviance::Point;
using Random = std::mt19937_64;

constexpr int bias_replicates = 400;

/// Numbers that would be printed of lost readings of these curves.
class Printer {
 public:
  explicit Printer(const PublishedDeviance& deviance) : deviance_(deviance) {}

  // y = F + e: Q^T y is normal about f + A x, and |(I - H) y|^2 = (|v + V x| + sigma e)^2 + sigma^2 chi^2_(n
  // - 4).
  std::vector<PublishedNumbers> draw(const Point& truth, Random& random) {
    std::vector<PublishedNumbers> result;
    for (std::size_t k = 0; k < deviance_.series().size(); ++k) {
      const PublishedSeries& one = deviance_.series()[k];
      const LinearCurve& curve = deviance_.curves()[k];
      double sigma = truth.sigma(one, static_cast<Index>(k));
      if (truth.own.size() > 0 && !one.sigma)
        sigma = std::exp(truth.log_sigma + scatter_spread * normal_(random));
      Eigen::Vector3d coefficients = curve.f + curve.A * truth.step;
      for (Index i = 0; i < 3; ++i) coefficients[i] += sigma * normal_(random);
      const double along = (curve.v + curve.V * truth.step).norm() + sigma * normal_(random);
      double squares = along * along;
      if (one.count > 4.0) {
        squares += sigma * sigma * std::chi_squared_distribution<double>(one.count - 4.0)(random);
      }
      const double about_mean = one.about_mean(coefficients);
      const double unit = std::pow(10.0, one.digits);
      const double r2 = std::round(about_mean / (about_mean + squares) * unit) / unit;
      result.push_back(published_numbers(coefficients, about_mean, r2, one.digits));
    }
    return result;
  }

 private:
  const PublishedDeviance& deviance_;
  std::normal_distribution<double> normal_;
};

/// Share of values at least as large as x, the observed one counted among them.
double tail(const std::vector<double>& values, double x) {
  const auto above = std::ranges::count_if(values, [x](double v) { return v >= x; });
  return (1.0 + static_cast<double>(above)) / (1.0 + static_cast<double>(values.size()));
}

}  // namespace

BootstrapResult published_bootstrap(const PublishedDeviance& deviance, const Point& best, int replicates) {
  Random random(20070611);
  Printer printer(deviance);
  BootstrapResult result;
  Point truth = best;
  if (deviance.estimates_sigma()) {
    double sum = 0.0;
    for (int k = 0; k < bias_replicates; ++k) {
      sum +=
          std::exp(2.0 * (deviance.minimise(printer.draw(truth, random), truth).log_sigma - truth.log_sigma));
    }
    result.bias = sum / bias_replicates;
    truth.log_sigma -= 0.5 * std::log(result.bias);
  }
  std::vector<double> misfits;
  for (int k = 0; k < replicates; ++k) {
    const std::vector<PublishedNumbers> numbers = printer.draw(truth, random);
    misfits.push_back(deviance.misfit(numbers, deviance.minimise(numbers, truth)));
  }
  result.p = tail(misfits, deviance.misfit(best));
  return result;
}

}  // namespace snare::identification
