#include "identification/fitting/statistics.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/non_central_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace snare::identification {

namespace bm = boost::math;

double chi_square_tail(double x, double dof) {
  if (!(x > 0.0)) return 1.0;
  if (std::isinf(x)) return 0.0;
  return bm::cdf(bm::complement(bm::chi_squared(dof), x));
}

double chi_square_mixture_tail(double x, const Eigen::VectorXd& weights) {
  const Eigen::ArrayXd w = weights.array().max(0.0);
  const double c1 = w.sum();
  const double c2 = w.square().sum();
  const double c3 = w.cube().sum();
  const double c4 = w.square().square().sum();
  if (!(c2 > 0.0)) return 1.0;
  const double s1 = c3 / std::pow(c2, 1.5);
  const double s2 = c4 / (c2 * c2);
  double a = 1.0 / s1;
  double noncentrality = 0.0;
  double dof = a * a;
  if (s1 * s1 > s2) {
    a = 1.0 / (s1 - std::sqrt(s1 * s1 - s2));
    noncentrality = s1 * a * a * a - a * a;
    dof = a * a - 2.0 * noncentrality;
  }
  const double at = (x - c1) / std::sqrt(2.0 * c2) * std::sqrt(2.0) * a + dof + noncentrality;
  if (!(at > 0.0)) return 1.0;
  if (noncentrality <= 0.0) return bm::cdf(bm::complement(bm::chi_squared(dof), at));
  return bm::cdf(bm::complement(bm::non_central_chi_squared(dof, noncentrality), at));
}

double normal_tail(double z) {
  return bm::cdf(bm::complement(bm::normal(), z));
}

double normal_quantile(double p) {
  return bm::quantile(bm::complement(bm::normal(), p));
}

namespace {

/// Beyond it a variance counts as known.
constexpr double many = 1e5;

/// P(noncentral F <= x).
double noncentral_share(double x, double above, double below, double noncentrality) {
  if (below > many) return bm::cdf(bm::non_central_chi_squared(above, noncentrality), above * x);
  return bm::cdf(bm::non_central_f(above, below, noncentrality), x);
}

}  // namespace

double student_tail(double z, double dof) {
  if (!(dof < many)) return normal_tail(z);
  return bm::cdf(bm::complement(bm::students_t(dof), z));
}

double student_quantile(double p, double dof) {
  if (!(dof < many)) return normal_quantile(p);
  return bm::quantile(bm::complement(bm::students_t(dof), p));
}

double fisher_tail(double x, double above, double below) {
  if (!(x > 0.0)) return 1.0;
  if (!(below < many)) return chi_square_tail(above * x, above);
  return bm::cdf(bm::complement(bm::fisher_f(above, below), x));
}

double noncentrality_upper(double x, double above, double below, double level) {
  if (!(x > 0.0)) return 0.0;
  const double share = 1.0 - level;
  // Large ones by their normal limit: Boost's series are slow there. Noncentral F about 1 + l / above, its
  // variance 2 (above + 2 l) / above^2 + 2 (1 + l / above)^2 / below.
  constexpr double large = 3000.0;
  double low = 0.0;
  double high = above * x + 10.0;
  const auto too_likely = [&](double l) {
    if (l < large) return noncentral_share(x, above, below, l) > share;
    const double mean = 1.0 + l / above;
    const double variance = 2.0 * (above + 2.0 * l) / (above * above) + 2.0 * mean * mean / below;
    return normal_tail((mean - x) / std::sqrt(variance)) > share;
  };
  if (!too_likely(0.0)) return 0.0;
  while (too_likely(high) && high < 1e12) high *= 2.0;
  for (int k = 0; k < 60 && high - low > 1e-6 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (too_likely(middle) ? low : high) = middle;
  }
  return high;
}

double runs_p(const std::vector<Eigen::VectorXd>& residuals) {
  // R runs among n1 positive and n2 negative entries: mean 1 + 2 n1 n2/n, variance (m - 1)(m - 2)/(n - 1), m
  // the mean.
  double excess = 0.0;
  double variance = 0.0;
  for (const Eigen::VectorXd& r : residuals) {
    const auto n = static_cast<double>(r.size());
    if (n < 4.0) continue;
    const auto positive = static_cast<double>((r.array() > 0.0).count());
    double runs = 1.0;
    for (Eigen::Index i = 1; i < r.size(); ++i) runs += (r[i] > 0.0) != (r[i - 1] > 0.0) ? 1.0 : 0.0;
    // One sign throughout: as if one entry had the other sign.
    const double n1 = std::clamp(positive, 1.0, n - 1.0);
    const double mean = 1.0 + 2.0 * n1 * (n - n1) / n;
    excess += runs - mean;
    variance += std::max((mean - 1.0) * (mean - 2.0) / (n - 1.0), 0.0);
  }
  if (variance <= 0.0) return 1.0;
  return std::min(1.0, 2.0 * normal_tail(std::abs(excess) / std::sqrt(variance)));
}

double ljung_box_p(const std::vector<Eigen::VectorXd>& residuals, int lags) {
  double q = 0.0;
  double dof = 0.0;
  for (const Eigen::VectorXd& r : residuals) {
    const Eigen::Index n = r.size();
    const int most = std::min(lags, static_cast<int>(n / 4));
    const double square = r.squaredNorm();
    if (most < 1 || square == 0.0) continue;
    for (int k = 1; k <= most; ++k) {
      const double rho = r.head(n - k).dot(r.tail(n - k)) / square;
      q += static_cast<double>(n) * static_cast<double>(n + 2) * rho * rho / static_cast<double>(n - k);
      dof += 1.0;
    }
  }
  return dof > 0.0 ? chi_square_tail(q, dof) : 1.0;
}

double uniform_p(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto rank = static_cast<double>(i);
    distance = std::max({distance, values[i] - rank / n, (rank + 1.0) / n - values[i]});
  }
  const double x = distance * (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n));
  double p = 0.0;
  for (int j = 1; j < 100; ++j) p += (j % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * j * j * x * x);
  return std::clamp(p, 0.0, 1.0);
}

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&p](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> result(p.size(), 1.0);
  double running = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    running = std::max(running, std::min(1.0, static_cast<double>(order.size() - i) * p[order[i]]));
    result[order[i]] = running;
  }
  return result;
}

}  // namespace snare::identification
