#pragma once

#include <Eigen/Core>

#include <vector>

namespace snare::identification {

/// P(chi-square with `dof` degrees of freedom > x), x >= 0, dof > 0.
[[nodiscard]] double chi_square_tail(double x, double dof);

/// P(sum_k weight_k X_k^2 > x) [-], X_k independent standard normal, weights >= 0 (negative round-off counts
/// as 0): by the noncentral chi-square of the same first moments (Liu, Tang and Zhang 2009). 1 where all
/// weights vanish.
[[nodiscard]] double chi_square_mixture_tail(double x, const Eigen::VectorXd& weights);

/// P(standard normal > z) [-].
[[nodiscard]] double normal_tail(double z);

/// z [-] with P(standard normal > z) = p, p in (0, 1).
[[nodiscard]] double normal_quantile(double p);

/// P(Student's t with `dof` degrees of freedom > z), dof > 0; infinite: normal.
[[nodiscard]] double student_tail(double z, double dof);

/// z [-] with P(Student's t with `dof` degrees of freedom > z) = p, p in (0, 1), dof > 0; infinite: normal.
[[nodiscard]] double student_quantile(double p, double dof);

/// P(Fisher's F with `above` and `below` degrees of freedom > x), both > 0; infinite below: chi-square over
/// `above`.
[[nodiscard]] double fisher_tail(double x, double above, double below);

/// Upper end of the one-sided confidence interval, at `level`, of the noncentrality of F, of which x was
/// seen: the noncentrality with which as little as x comes about with probability 1 - level. 0 where even
/// none makes x too small.
[[nodiscard]] double noncentrality_upper(double x, double above, double below, double level);

/// Two-sided p of the number of runs of one sign, series by series, added up as normal deviates (Wald and
/// Wolfowitz 1940). 1 where every series has one sign only and fewer than 4 entries.
[[nodiscard]] double runs_p(const std::vector<Eigen::VectorXd>& residuals);

/// Ljung and Box (1978) [-]: Q = n (n + 2) sum_k rho_k^2 / (n - k) over up to `lags` lags, at most a quarter
/// of the entries, added over the series; p by chi-square.
[[nodiscard]] double ljung_box_p(const std::vector<Eigen::VectorXd>& residuals, int lags);

/// P of the Kolmogorov-Smirnov test that values are uniform on [0, 1], with Stephens' (1970) correction for
/// their number.
[[nodiscard]] double uniform_p(std::vector<double> values);

/// Holm's (1979) adjusted p values [-], in the order given.
[[nodiscard]] std::vector<double> holm(const std::vector<double>& p);

}  // namespace snare::identification
