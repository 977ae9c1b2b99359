#include "identification/fitting/noncentral_chi.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace snare::identification {

namespace {

/// Without a detour over long double.
using in_double = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

/// With 0F1(; k/2; z^2/4) = Gamma(k/2) (z/2)^(-nu) I_nu(z), nu = k/2 - 1.
struct Bessel {
  double scaled = 0.0;  ///< log(0F1 / Gamma(k/2)) - z
  double ratio = 0.0;   ///< I_(nu+1)(z) / (z I_nu(z)) = d log 0F1 / dz / z
};

// 0F1 = sum_j a_j, a_j = (z/2)^(2j) / (j! (k/2)_j);  d log 0F1 / dz / z = 1/2 sum_j a_j / (k/2 + j) / sum_j
// a_j. All terms are positive.
Bessel by_series(double half, double z, double log_gamma) {
  const double x = 0.25 * z * z;
  double term = 1.0;
  double sum = 1.0;
  double weighted = 1.0 / half;
  for (int j = 1; j < 200; ++j) {
    const double previous = half + j - 1.0;
    term *= x / (j * previous);
    sum += term;
    weighted += term / (previous + 1.0);
    if (term < 1e-17 * sum) break;
  }
  return {std::log(sum) - log_gamma - z, 0.5 * weighted / sum};
}

// Debye's expansion, uniform in nu and z (Abramowitz and Stegun 9.7.7), with R = sqrt(nu^2 + z^2), q = 1/R:
//   log I_nu = R + nu log(z / (nu + R)) - 1/2 log(2 pi R) + log(1 + S),   S = sum_j u_j(nu q) / nu^j,
// a polynomial in q and nu, so that nu may be zero.
Bessel by_debye(double nu, double z) {
  const double r = std::sqrt(nu * nu + z * z);
  const double q = 1.0 / r;
  const double n2 = nu * nu * q * q;
  const std::array<std::array<double, 5>, 4> u{
      {{3.0 / 24.0, -5.0 / 24.0},
       {81.0 / 1152.0, -462.0 / 1152.0, 385.0 / 1152.0},
       {30375.0 / 414720.0, -369603.0 / 414720.0, 765765.0 / 414720.0, -425425.0 / 414720.0},
       {4465125.0 / 39813120.0, -94121676.0 / 39813120.0, 349922430.0 / 39813120.0, -446185740.0 / 39813120.0,
        185910725.0 / 39813120.0}}};
  double sum = 0.0;
  double slope = 0.0;  // q dS/dq
  double power = 1.0;  // q^j
  for (std::size_t j = 0; j < u.size(); ++j) {
    power *= q;
    double even = 1.0;
    for (std::size_t i = 0; i <= j + 1; ++i) {
      const double term = u[j][i] * power * even;
      sum += term;
      slope += static_cast<double>(j + 1 + 2 * i) * term;
      even *= n2;
    }
  }
  Bessel result;
  result.scaled = nu * nu / (r + z) - nu * std::log(0.5 * (nu + r)) -
                  0.5 * std::log(2.0 * std::numbers::pi * r) + std::log1p(sum);
  result.ratio = 1.0 / (r + nu) - 0.5 * q * q - q * q * slope / (1.0 + sum);
  return result;
}

Bessel bessel(double components, double z, double log_gamma) {
  // From here on five terms of Debye's expansion leave an error below 1e-7.
  constexpr double large = 20.0;
  const double half = 0.5 * components;
  const double nu = half - 1.0;
  return z < large && nu < large ? by_series(half, z, log_gamma) : by_debye(nu, z);
}

/// log f at one length, with the derivatives by q and s of log(f / sigma), the density of the length itself.
struct Density {
  double log = 0.0;
  double q = 0.0, s = 0.0, qq = 0.0, qs = 0.0, ss = 0.0;
  double along = 0.0;  ///< d log f / dt
};

// With z = m t, rho = I_(nu+1) / (z I_nu) and kappa = rho' / z = (1 - z^2 rho^2 - k rho) / z^2 (which is -2 /
// (k^2 (k + 2)) at z = 0):
//   d/dq = (t^2 rho - 1) / (2 sigma^2),  d/ds = t^2 + m^2 - 2 z^2 rho - k, and so on.
Density density(double t, double k, double m, double sigma, double log_gamma) {
  const double z = m * t;
  const Bessel b = bessel(k, z, log_gamma);
  const double rho = b.ratio;
  const double z2 = z * z;
  const double kappa = z < 0.1 ? -2.0 / (k * k * (k + 2.0)) : (1.0 - z2 * rho * rho - k * rho) / z2;
  const double variance = sigma * sigma;
  Density d;
  d.log = (k - 1.0) * std::log(t) - (0.5 * k - 1.0) * std::numbers::ln2 - 0.5 * (t - m) * (t - m) + b.scaled;
  d.q = (t * t * rho - 1.0) / (2.0 * variance);
  d.s = (t - m) * (t - m) + 2.0 * z * (1.0 - z * rho) - k;
  d.qq = t * t * t * t * kappa / (4.0 * variance * variance);
  d.qs = (1.0 - 2.0 * t * t * rho - t * t * z2 * kappa) / variance;
  d.ss = -2.0 * (t * t + m * m) + 8.0 * z2 * rho + 4.0 * z2 * z2 * kappa;
  d.along = (k - 1.0) / t - t + m * z * rho;
  return d;
}

/// Sums densities in logarithms: log of the sum, means of the derivatives, and the covariance of the first
/// ones.
class Sum {
 public:
  void add(const Density& d, double log_weight) {
    const double log = d.log + log_weight;
    if (log > largest_) {
      const double scale = std::exp(largest_ - log);
      for (double& m : moments_) m *= scale;
      largest_ = log;
    }
    const double w = std::exp(log - largest_);
    const std::array<double, 6> values{1.0, d.q, d.s, d.qq + d.q * d.q, d.qs + d.q * d.s, d.ss + d.s * d.s};
    for (std::size_t i = 0; i < values.size(); ++i) moments_[i] += w * values[i];
  }
  [[nodiscard]] IntervalProbability result() const {
    const double w = moments_[0];
    IntervalProbability p;
    p.log = std::min(0.0, largest_ + std::log(w));
    p.by_square = moments_[1] / w;
    p.by_scale = moments_[2] / w;
    p.by_square_square = moments_[3] / w - p.by_square * p.by_square;
    p.by_square_scale = moments_[4] / w - p.by_square * p.by_scale;
    p.by_scale_scale = moments_[5] / w - p.by_scale * p.by_scale;
    return p;
  }

 private:
  double largest_ = -std::numeric_limits<double>::infinity();
  std::array<double, 6> moments_{};
};

template <unsigned Points>
void add_panel(double a, double b, const auto& density_at, Sum& sum) {
  if (!(b > a)) return;
  using Gauss = boost::math::quadrature::gauss<double, Points>;
  const double half = 0.5 * (b - a);
  for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
    const double x = Gauss::abscissa()[i];
    const double log_weight = std::log(Gauss::weights()[i] * half);
    sum.add(density_at(0.5 * (a + b) + half * x), log_weight);
    if (x > 0.0) sum.add(density_at(0.5 * (a + b) - half * x), log_weight);
  }
}

}  // namespace

double log_noncentral_chi(double t, double components, double mean) {
  return density(t, components, mean, 1.0, boost::math::lgamma(0.5 * components, in_double())).log;
}

// The density of t has one peak, near sqrt(k - 1 + m^2), and a standard deviation of at most one; above the
// peak it falls faster than a normal one. Beyond 9 deviations, or where it has fallen by e^-45 along its
// slope, nothing counts.
IntervalProbability length_probability(double lower, double upper, double components, double square,
                                       double log_sigma) {
  const double sigma = std::exp(log_sigma);
  const double m = std::sqrt(square) / sigma;
  const double log_gamma = boost::math::lgamma(0.5 * components, in_double());
  const auto at = [&](double t) { return density(t, components, m, sigma, log_gamma); };
  constexpr double far = 9.0;
  double a = lower / sigma;
  double b = upper / sigma;
  const double peak = std::clamp(std::sqrt(components - 1.0 + m * m), a, b);
  b = std::min(b, peak + far);
  a = std::max(a, peak - far);
  Sum sum;
  if (a > 0.0 && b - a < 1.0) {
    const double slope = std::max(std::abs(at(a).along), std::abs(at(b).along));
    const double size = 0.5 * (b - a) * (1.0 + slope);
    if (size < 4.0) {
      size < 0.5 ? add_panel<3>(a, b, at, sum) : add_panel<7>(a, b, at, sum);
      return sum.result();
    }
  }
  constexpr double least = 45.0;  // of the logarithm
  if (peak > 0.0) {
    const double slope = std::abs(at(peak).along);
    if (peak == a) b = std::min(b, a + least / std::max(slope, 1.0));
    if (peak == b) a = std::max(a, b - least / std::max(slope, 1.0));
  }
  add_panel<20>(a, peak, at, sum);
  add_panel<20>(peak, b, at, sum);
  return sum.result();
}

}  // namespace snare::identification
