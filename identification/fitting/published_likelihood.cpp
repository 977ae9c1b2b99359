#include "identification/fitting/published_likelihood.hpp"

#include "identification/fitting/prediction.hpp"
#include "numerics/dense_solvers.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

using Eigen::Index;

/// Columns d^2, d, 1 with d over the longest travel, so that they are of one size.
Eigen::MatrixXd quadratics(const std::vector<double>& travel) {
  double longest = 0.0;
  for (const double d : travel) longest = std::max(longest, std::abs(d));
  if (longest == 0.0) longest = 1.0;
  Eigen::MatrixXd x(static_cast<Index>(travel.size()), 3);
  for (Index i = 0; i < x.rows(); ++i) {
    const double u = travel[static_cast<std::size_t>(i)] / longest;
    x.row(i) << u * u, u, 1.0;
  }
  return x;
}

/// Gram and Schmidt twice: orthonormal to round-off.
Eigen::MatrixXd orthonormal(Eigen::MatrixXd x) {
  for (Index k = 0; k < x.cols(); ++k) {
    for (int pass = 0; pass < 2; ++pass) {
      for (Index j = 0; j < k; ++j) x.col(k) -= x.col(j).dot(x.col(k)) * x.col(j);
    }
    const double norm = x.col(k).norm();
    if (norm > 0.0) x.col(k) /= norm;
  }
  return x;
}

/// SSE in the middle of the printed interval [N^2], > 0 unless the parabola is a constant.
double middle_squares(const PublishedNumbers& numbers) {
  const double low = numbers.lower * numbers.lower;
  return std::isfinite(numbers.upper) ? 0.5 * (low + numbers.upper * numbers.upper) : 2.0 * low;
}

/// q >= 0 with the greatest probability of a printed R2 [N^2]: log P has one maximum, at zero or where its
/// derivative changes sign.
double likeliest_square(const PublishedNumbers& numbers, double components, double log_sigma) {
  const auto rises_at = [&](double root) {
    return length_probability(numbers.lower, numbers.upper, components, root * root, log_sigma).by_square >
           0.0;
  };
  const double length = std::isfinite(numbers.upper) ? numbers.upper : numbers.lower;
  double low = 0.0;
  double high = length + 10.0 * std::exp(log_sigma);  // of sqrt(q)
  if (!rises_at(0.0)) high = 0.0;
  while (high - low > 1e-10 * high) {
    const double middle = 0.5 * (low + high);
    (rises_at(middle) ? low : high) = middle;
  }
  return high * high;
}

/// -2 log likelihood of a parabola of its own for a series, with its own standard deviation unless that is
/// declared.
double own_parabola(const PublishedSeries& series, const PublishedNumbers& numbers) {
  const double s =
      series.sigma
          ? std::log(*series.sigma)
          : std::log(std::max(std::sqrt(middle_squares(numbers) / series.count), series.least_sigma));
  return 6.0 * s - 2.0 * length_probability(numbers.lower, numbers.upper, series.count - 3.0, 0.0, s).log;
}

}  // namespace

Eigen::MatrixXd quadratic_basis(const std::vector<double>& travel) {
  return orthonormal(quadratics(travel)).transpose();
}

QuadraticLaw printed_law(const std::vector<double>& travel, const Eigen::VectorXd& force, int digits) {
  Eigen::MatrixXd x(force.size(), 3);
  for (Index i = 0; i < x.rows(); ++i) {
    const double mm = 1e3 * travel[static_cast<std::size_t>(i)];
    x.row(i) << mm * mm, mm, 1.0;
  }
  const Eigen::Vector3d c = numerics::full_rank_least_squares(x, force);
  const double r2 = 1.0 - (force - x * c).squaredNorm() / (force.array() - force.mean()).square().sum();
  const double unit = std::pow(10.0, digits);
  return {1e6 * c[0], 1e3 * c[1], c[2], std::round(r2 * unit) / unit, travel.back(), digits};
}

PublishedNumbers published_numbers(const Eigen::Vector3d& coefficients, double about_mean, double r_squared,
                                   int digits) {
  const double half = 0.5 * std::pow(10.0, -digits);
  const double high = std::min(1.0, r_squared + half);
  const double low = r_squared - half;
  const auto squares = [&](double r2) { return about_mean * (1.0 - r2) / r2; };
  return {coefficients, std::sqrt(squares(high)),
          low > 0.0 ? std::sqrt(squares(low)) : std::numeric_limits<double>::infinity()};
}

std::vector<PublishedSeries> published_series(const std::vector<Series>& series) {
  std::vector<PublishedSeries> result;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const std::vector<double>& travel = measured_displacement(series[k]);
    if (!series[k].law || travel.size() < 4) continue;
    const QuadraticLaw& law = *series[k].law;
    PublishedSeries& one = result.emplace_back();
    one.index = k;
    one.basis = quadratic_basis(travel);
    one.count = static_cast<double>(travel.size());
    one.mean = one.basis.rowwise().sum() / std::sqrt(one.count);
    one.digits = law.r_squared_digits;
    one.sigma = series[k].force_sigma;
    Eigen::VectorXd parabola(one.basis.cols());
    for (Index i = 0; i < parabola.size(); ++i) parabola[i] = law.force(travel[static_cast<std::size_t>(i)]);
    one.least_sigma = std::max(1e-6 * parabola.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    const Eigen::Vector3d coefficients = one.basis * parabola;
    one.numbers = published_numbers(coefficients, one.about_mean(coefficients), law.r_squared, one.digits);
  }
  return result;
}

double scatter_about_parabolas(const std::vector<PublishedSeries>& series) {
  double squares = 0.0;
  double count = 0.0;
  double least = std::numeric_limits<double>::max();
  for (const PublishedSeries& s : series) {
    squares += middle_squares(s.numbers);
    count += s.count - 3.0;
    least = std::min(least, s.least_sigma);
  }
  return std::max(std::sqrt(squares / std::max(1.0, count)), least);
}

double estimated_scatters(const std::vector<PublishedSeries>& series, PublishedScatter scatter) {
  const auto unknown =
      static_cast<double>(std::ranges::count_if(series, [](const PublishedSeries& s) { return !s.sigma; }));
  return scatter == PublishedScatter::each ? unknown : std::min(1.0, unknown);
}

IntervalProbability PublishedRows::probability(double square) const {
  return length_probability(series_.numbers.lower, series_.numbers.upper, series_.count - 3.0, square,
                            std::log(sigma_));
}

void PublishedRows::set_sigma(double sigma) {
  sigma_ = sigma;
  best_square_ = likeliest_square(series_.numbers, series_.count - 3.0, std::log(sigma));
  best_log_ = probability(best_square_).log;
}

Eigen::MatrixXd PublishedRows::whiten(const Eigen::MatrixXd& values) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(count, values.cols());
  result.topRows(3) = series_.basis * values / sigma_;
  return result;
}

Eigen::VectorXd PublishedRows::off_parabola(const Eigen::VectorXd& force) const {
  return force - series_.basis.transpose() * (series_.basis * force);
}

double PublishedRows::r_squared_residual(const Eigen::VectorXd& force) const {
  const double square = off_parabola(force).squaredNorm();
  const double size = std::sqrt(2.0 * std::max(0.0, best_log_ - probability(square).log));
  return square > best_square_ ? -size : size;
}

// r^2 = 2 (max L - L): dr/dq = -L'/r, at the maximum -sqrt(-L'').
Eigen::RowVectorXd PublishedRows::r_squared_slope(const Eigen::VectorXd& force,
                                                  const Eigen::MatrixXd& by) const {
  constexpr double near_maximum = 1e-4;
  const Eigen::VectorXd off = off_parabola(force);
  const IntervalProbability at = probability(off.squaredNorm());
  const double r = r_squared_residual(force);
  const double slope =
      std::abs(r) > near_maximum ? at.by_square / r : std::sqrt(std::max(0.0, -at.by_square_square));
  return 2.0 * slope * off.transpose() * by;
}

LinearCurve linear_curve(const PublishedSeries& series, const Eigen::VectorXd& force,
                         const Eigen::MatrixXd& by) {
  LinearCurve curve;
  curve.f = series.basis * force;
  curve.A = series.basis * by;
  // (I - H)(V, v) = U R: only R counts.
  Eigen::MatrixXd off(force.size(), by.cols() + 1);
  off << by - series.basis.transpose() * curve.A, force - series.basis.transpose() * curve.f;
  const Index rows = std::min(off.rows(), off.cols());
  const Eigen::MatrixXd r =
      Eigen::HouseholderQR<Eigen::MatrixXd>(off).matrixQR().topRows(rows).triangularView<Eigen::Upper>();
  curve.V = r.leftCols(by.cols());
  curve.v = r.col(by.cols());
  return curve;
}

double PublishedDeviance::Point::sigma(const PublishedSeries& one, Index k) const {
  return one.sigma ? *one.sigma : std::exp(log_sigma + (own.size() > 0 ? own[k] : 0.0));
}

/// -2 log likelihood at a point, its gradient and second derivatives, and a positive scale of the latter's
/// diagonal.
struct PublishedDeviance::Value {
  double deviance = 0.0;
  double coefficients = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  Eigen::VectorXd scale;
};

PublishedDeviance::PublishedDeviance(std::vector<PublishedSeries> series, std::vector<LinearCurve> curves,
                                     PublishedScatter scatter)
    : series_(std::move(series)), curves_(std::move(curves)), scatter_(scatter) {
  double least = std::numeric_limits<double>::max();
  for (const PublishedSeries& s : series_) least = std::min(least, s.least_sigma);
  least_log_sigma_ = std::log(least);
}

bool PublishedDeviance::estimates_sigma() const {
  return std::ranges::any_of(series_, [](const PublishedSeries& s) { return !s.sigma; });
}

Index PublishedDeviance::unknowns() const {
  return steps() + 1 + (scatter_ == PublishedScatter::each ? static_cast<Index>(series_.size()) : 0);
}

PublishedDeviance::Point PublishedDeviance::point_of(const Eigen::VectorXd& x) const {
  Point point;
  point.step = x.head(steps());
  point.log_sigma = x[steps()];
  point.own = x.tail(unknowns() - steps() - 1);
  return point;
}

PublishedDeviance::Point PublishedDeviance::start() const {
  Point point;
  point.step = Eigen::VectorXd::Zero(steps());
  point.log_sigma = std::log(scatter_about_parabolas(series_));
  point.own = Eigen::VectorXd::Zero(unknowns() - steps() - 1);
  return point;
}

// With r = Q^T y - f - A x, c = v + V x, q = |c|^2, s the logarithm of a series' standard deviation and L(q,
// s) = log P of its interval:
//   D = sum 6 s + |r|^2 e^(-2s) - 2 L(q, s) + (u / 0.3)^2, less the same of a parabola for each,
//     which minimise() takes off.
PublishedDeviance::Value PublishedDeviance::at(const std::vector<PublishedNumbers>& numbers,
                                               const Eigen::VectorXd& x) const {
  const Index p = steps();
  const Index all = unknowns();
  const bool each = scatter_ == PublishedScatter::each;
  Value value{.gradient = Eigen::VectorXd::Zero(all),
              .hessian = Eigen::MatrixXd::Zero(all, all),
              .scale = Eigen::VectorXd::Constant(all, 1e-12)};
  for (std::size_t k = 0; k < series_.size(); ++k) {
    const PublishedSeries& one = series_[k];
    const LinearCurve& curve = curves_[k];
    const Index own = p + 1 + static_cast<Index>(k);
    const double s = one.sigma ? std::log(*one.sigma) : x[p] + (each ? x[own] : 0.0);
    const double weight = std::exp(-2.0 * s);
    const Eigen::Vector3d r = numbers[k].coefficients - curve.f - curve.A * x.head(p);
    const Eigen::VectorXd c = curve.v + curve.V * x.head(p);
    const IntervalProbability l =
        length_probability(numbers[k].lower, numbers[k].upper, one.count - 3.0, c.squaredNorm(), s);
    const double square = r.squaredNorm() * weight;
    value.coefficients += square;
    value.deviance += 6.0 * s + square - 2.0 * l.log;
    const Eigen::VectorXd ar = curve.A.transpose() * r;
    const Eigen::VectorXd vc = curve.V.transpose() * c;
    const Eigen::MatrixXd aa = 2.0 * weight * (curve.A.transpose() * curve.A);
    const Eigen::MatrixXd vv = curve.V.transpose() * curve.V;
    value.gradient.head(p) -= 2.0 * weight * ar + 4.0 * l.by_square * vc;
    value.hessian.topLeftCorner(p, p) +=
        aa - 4.0 * l.by_square * vv - 8.0 * l.by_square_square * vc * vc.transpose();
    value.scale.head(p) += aa.diagonal() + 2.0 * weight * vv.diagonal();
    if (one.sigma) continue;
    const double by_s = 6.0 - 2.0 * square - 2.0 * l.by_scale;
    const double by_ss = 4.0 * square - 2.0 * l.by_scale_scale;
    const Eigen::VectorXd cross = 4.0 * weight * ar - 4.0 * l.by_square_scale * vc;
    const auto add = [&](Index i) {
      value.gradient[i] += by_s;
      value.hessian(i, i) += by_ss;
      value.scale[i] += 2.0 * one.count;
      value.hessian.col(i).head(p) += cross;
      value.hessian.row(i).head(p) += cross.transpose();
    };
    add(p);
    if (!each) continue;
    constexpr double prior = 1.0 / (scatter_spread * scatter_spread);
    add(own);
    value.hessian(own, p) += by_ss;
    value.hessian(p, own) += by_ss;
    value.deviance += prior * x[own] * x[own];
    value.gradient[own] += 2.0 * prior * x[own];
    value.hessian(own, own) += 2.0 * prior;
  }
  return value;
}

std::vector<PublishedNumbers> PublishedDeviance::own_numbers() const {
  std::vector<PublishedNumbers> numbers;
  for (const PublishedSeries& s : series_) numbers.push_back(s.numbers);
  return numbers;
}

PublishedDeviance::Point PublishedDeviance::minimise(const Point& start) const {
  return minimise(own_numbers(), start);
}

namespace {

/// max over s of log P(S | q, s) - 3 log s [-], by Newton's method from (S - q) / n.
double through_the_parabola(const PublishedSeries& one, const PublishedNumbers& numbers, double square) {
  constexpr int most = 12;
  constexpr double longest = 0.5, enough = 1e-4;  // of log s: the maximum is flat
  const double free = std::max(middle_squares(numbers) - square, 1e-3 * square) / one.count;
  double s = std::max(0.5 * std::log(free), std::log(one.least_sigma));
  double best = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < most; ++k) {
    const IntervalProbability at =
        length_probability(numbers.lower, numbers.upper, one.count - 3.0, square, s);
    best = std::max(best, at.log - 3.0 * s);
    const double slope = at.by_scale - 3.0, bend = at.by_scale_scale;
    const double step = bend < 0.0 ? -slope / bend : std::copysign(0.2 * longest, slope);
    if (std::abs(step) < enough) break;
    s += std::clamp(step, -longest, longest);
  }
  return best;
}

}  // namespace

double PublishedDeviance::misfit(const std::vector<PublishedNumbers>& numbers, const Point& point) const {
  constexpr double curved = 0.75;  // of SSE
  double misfit = 0.0;
  for (std::size_t k = 0; k < series_.size(); ++k) {
    const PublishedSeries& one = series_[k];
    const double sigma = point.sigma(one, static_cast<Index>(k)), s = std::log(sigma);
    const Eigen::Vector3d r = numbers[k].coefficients - curves_[k].f - curves_[k].A * point.step;
    const double square = (curves_[k].v + curves_[k].V * point.step).squaredNorm();
    const auto log_of = [&](double q) {
      return length_probability(numbers[k].lower, numbers[k].upper, one.count - 3.0, q, s).log;
    };
    const double through =
        one.sigma
            ? log_of(likeliest_square(numbers[k], one.count - 3.0, s)) - 3.0 * s
            : through_the_parabola(one, numbers[k], std::min(square, curved * middle_squares(numbers[k])));
    misfit += 6.0 * s + r.squaredNorm() / (sigma * sigma) - 2.0 * log_of(square) + 2.0 * through;
  }
  return misfit;
}

double PublishedDeviance::misfit(const Point& point) const {
  return misfit(own_numbers(), point);
}

PublishedDeviance::Point PublishedDeviance::minimise(const std::vector<PublishedNumbers>& numbers,
                                                     const Point& start) const {
  constexpr int most = 100;
  constexpr double enough = 1e-7;        // of the deviance: its standard deviation is of order one
  constexpr double longest_scale = 1.0;  // step of the logarithm of a standard deviation
  const Index p = steps();
  Eigen::VectorXd x(unknowns());
  x << start.step, start.log_sigma, start.own;
  const bool estimated = estimates_sigma();
  Value now = at(numbers, x);
  double damping = 1e-8;
  for (int k = 0; k < most; ++k) {
    Eigen::MatrixXd damped = now.hessian;
    damped.diagonal() += damping * now.scale;
    const Eigen::LLT<Eigen::MatrixXd> factor(damped);
    bool better = false;
    double gain = 0.0;
    if (factor.info() == Eigen::Success) {
      Eigen::VectorXd step = -factor.solve(now.gradient);
      const double most_scale = step.tail(step.size() - p).cwiseAbs().maxCoeff();
      if (most_scale > longest_scale) step *= longest_scale / most_scale;
      Eigen::VectorXd next = x + step;
      if (estimated) next[p] = std::max(next[p], least_log_sigma_);
      gain = -now.gradient.dot(step) - 0.5 * step.dot(now.hessian * step);
      Value other = at(numbers, next);
      better = other.deviance < now.deviance;
      if (better) {
        gain = std::max(gain, now.deviance - other.deviance);
        x = next;
        now = std::move(other);
      } else if (std::abs(gain) < enough) {
        break;
      }
    }
    if (better && gain < enough) break;
    damping = better ? std::max(1e-8, 0.1 * damping) : std::max(1e-3, 10.0 * damping);
    if (damping > 1e12) break;
  }
  Point result = point_of(x);
  result.deviance = now.deviance;
  for (std::size_t i = 0; i < series_.size(); ++i) result.deviance -= own_parabola(series_[i], numbers[i]);
  result.coefficients = now.coefficients;
  return result;
}

}  // namespace snare::identification
