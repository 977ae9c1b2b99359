#pragma once

#include "identification/fitting/experiment.hpp"
#include "identification/fitting/noncentral_chi.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <vector>

namespace snare::identification {

/// Q^T, (3, n): an orthonormal basis of the quadratics over these travels [m], n >= 3, as rows. Readings y =
/// F(d) + e, e of variance sigma^2, give Q^T y the covariance sigma^2 I.
[[nodiscard]] Eigen::MatrixXd quadratic_basis(const std::vector<double>& travel);

/// The least-squares fit of A, B, C to readings, as a paper prints it. force: at n >= 4 travels [N]; digits:
/// decimals of R2.
[[nodiscard]] QuadraticLaw printed_law(const std::vector<double>& travel, const Eigen::VectorXd& force,
                                       int digits);

/// The numbers that a paper prints of one series, as data: three coefficients and an interval for the sum of
/// squares about them.                                                                       theory.md (I.11)
struct PublishedNumbers {
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();  ///< Q^T of the printed parabola [N]
  double lower = 0.0;  ///< sqrt(SSE) at the largest R2 that rounds to the printed one [N], >= 0
  double upper = 0.0;  ///< and at the smallest one [N]; infinite where R2 rounds to zero
};

/// A printed R2 stands for an interval of half a unit of its last digit either way. about_mean: SSR, the sum
/// of squares of the printed parabola about its mean [N^2]; SSE = SSR (1 - R2) / R2.
[[nodiscard]] PublishedNumbers published_numbers(const Eigen::Vector3d& coefficients, double about_mean,
                                                 double r_squared, int digits);

/// One series of which a fit was published: what does not change from one set of lost readings to the next.
struct PublishedSeries {
  std::size_t index = 0;        ///< of the model's series
  Eigen::MatrixXd basis;        ///< Q^T, (3, n)
  Eigen::Vector3d mean;         ///< Q^T (1, ..., 1) / sqrt(n) [-]
  double count = 0.0;           ///< n lost readings
  int digits = 4;               ///< decimals of the printed R2
  double least_sigma = 0.0;     ///< below which the digits of the printed coefficients count [N], > 0
  std::optional<double> sigma;  ///< of one reading, where it is declared [N]
  PublishedNumbers numbers;

  /// Sum of squares of a parabola about its mean, by its coefficients Q^T y [N^2].
  [[nodiscard]] double about_mean(const Eigen::Vector3d& coefficients) const {
    const double along = mean.dot(coefficients);
    return std::max(0.0, coefficients.squaredNorm() - along * along);
  }
};

/// The series with a law of four readings or more.
[[nodiscard]] std::vector<PublishedSeries> published_series(const std::vector<Series>& series);

/// Standard deviation of a lost reading if the wire's curve were a parabola, from all series together:
/// sigma^2 = sum SSE / sum (n - 3) [N]; an upper bound, to its own scatter, whatever the curve is. > 0.
[[nodiscard]] double scatter_about_parabolas(const std::vector<PublishedSeries>& series);

/// How many standard deviations are unknown, common or one each.
[[nodiscard]] double estimated_scatters(const std::vector<PublishedSeries>& series, PublishedScatter scatter);

/// The likelihood of one published fit with a standard deviation that is known, as residuals of a
/// least-squares fit:
///   r_1..3 = Q^T (y - F) / sigma,   r_4^2 = 2 (max L - L(q)),   q = |(I - H) F|^2,
/// L the logarithm of the probability of the printed R2; r_4 has the sign of (best q) - q.   theory.md (I.11)
class PublishedRows {
 public:
  static constexpr Eigen::Index count = 4;
  explicit PublishedRows(const PublishedSeries& series) : series_(series) {}
  void set_sigma(double sigma);  ///< [N], > 0; before any of the following
  /// Q^T values / sigma, and a row of zeros. values: forces at the travels [N], by columns.
  [[nodiscard]] Eigen::MatrixXd whiten(const Eigen::MatrixXd& values) const;
  /// r_4 [-] of computed forces [N].
  [[nodiscard]] double r_squared_residual(const Eigen::VectorXd& force) const;
  /// -dr_4 by the numbers [1 over the unit of each]. by: derivatives of the forces, a column a number.
  [[nodiscard]] Eigen::RowVectorXd r_squared_slope(const Eigen::VectorXd& force,
                                                   const Eigen::MatrixXd& by) const;

 private:
  [[nodiscard]] IntervalProbability probability(double square) const;
  [[nodiscard]] Eigen::VectorXd off_parabola(const Eigen::VectorXd& force) const;

  PublishedSeries series_;
  double sigma_ = 1.0;
  double best_square_ = 0.0;
  double best_log_ = 0.0;
};

/// The computed curve of one series, linear in steps x of the fitted coordinates: coefficients f + A x and,
/// off the parabolas, a vector of the length |v + V x| = |(I - H) F|.
struct LinearCurve {
  Eigen::Vector3d f;
  Eigen::MatrixXd A;  ///< (3, p)
  Eigen::VectorXd v;
  Eigen::MatrixXd V;  ///< (at most p + 1, p)
};

/// force: F at the n travels [N]; by: its derivatives by the coordinates, (n, p), p may be zero.
[[nodiscard]] LinearCurve linear_curve(const PublishedSeries& series, const Eigen::VectorXd& force,
                                       const Eigen::MatrixXd& by);

/// Deviance of published fits under linear curves: -2 log likelihood, less that of a parabola and a standard
/// deviation for every series, which have as many numbers as were printed.
///                                                                                           theory.md (I.11)
class PublishedDeviance {
 public:
  PublishedDeviance(std::vector<PublishedSeries> series, std::vector<LinearCurve> curves,
                    PublishedScatter scatter);

  /// Steps x, the logarithm s of the common standard deviation, and what each series has beside it.
  struct Point {
    Eigen::VectorXd step;
    double log_sigma = 0.0;
    Eigen::VectorXd own;        ///< one a series; empty with a common one
    double deviance = 0.0;      ///< [-]
    double coefficients = 0.0;  ///< of the coefficients, |Q^T (y - F)|^2 / sigma^2 of all series [-]
    /// Standard deviation of a reading of one of the series [N].
    [[nodiscard]] double sigma(const PublishedSeries& series, Eigen::Index k) const;
  };
  /// The least deviance, from a point near it; by Newton's method with damping. numbers: printed ones, one a
  /// series.
  [[nodiscard]] Point minimise(const std::vector<PublishedNumbers>& numbers, const Point& start) const;
  [[nodiscard]] Point minimise(const Point& start) const;
  /// What tests the model: the deviance at a point, against a curve for every series that goes through the
  /// printed parabola, with a standard deviation of its own s, and as curved as the computed one, up to three
  /// quarters of SSE:
  ///   M = sum 6 log(sigma / s) + |Q^T (y - F)|^2 / sigma^2 - 2 log P(q, sigma) + 2 log P(min(q, 3/4 SSE),
  ///     s),
  /// s of greatest likelihood [-]; where sigma is declared, s = sigma and q is the likeliest one. Its law
  /// hardly depends on the curves;
  /// that of `deviance` does.                                                                theory.md (I.11)
  [[nodiscard]] double misfit(const std::vector<PublishedNumbers>& numbers, const Point& point) const;
  [[nodiscard]] double misfit(const Point& point) const;
  /// No step, the scatter about parabolas.
  [[nodiscard]] Point start() const;

  /// Published series, in the order of the curves.
  [[nodiscard]] const std::vector<PublishedSeries>& series() const { return series_; }
  /// Computed curves, one a series.
  [[nodiscard]] const std::vector<LinearCurve>& curves() const { return curves_; }
  /// Number of fitted coordinates.
  [[nodiscard]] Eigen::Index steps() const { return curves_.front().A.cols(); }
  /// Whether a standard deviation is unknown.
  [[nodiscard]] bool estimates_sigma() const;

 private:
  struct Value;
  [[nodiscard]] std::vector<PublishedNumbers> own_numbers() const;
  [[nodiscard]] Value at(const std::vector<PublishedNumbers>& numbers, const Eigen::VectorXd& x) const;
  [[nodiscard]] Eigen::Index unknowns() const;
  [[nodiscard]] Point point_of(const Eigen::VectorXd& x) const;

  std::vector<PublishedSeries> series_;
  std::vector<LinearCurve> curves_;
  PublishedScatter scatter_;
  double least_log_sigma_ = 0.0;
};

}  // namespace snare::identification
