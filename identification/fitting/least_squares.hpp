#pragma once

#include "identification/fitting/data.hpp"
#include "identification/fitting/identifiability.hpp"
#include "identification/fitting/model.hpp"
#include "numerics/report.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace snare::identification {

/// What a fit has found; usable or not says its report.
struct Fit {
  std::vector<Setting> settings;  ///< fitted ones first, then the fixed ones
  std::size_t free = 0;           ///< how many are fitted
  Evaluation evaluation;          ///< at the optimum, with the derivatives by the fitted numbers
  Eigen::VectorXd residual;       ///< whitened
  Eigen::MatrixXd jacobian;       ///< whitened
  Eigen::MatrixXd covariance;     ///< of the coordinates, (J^T J)^-1 in the directions that the data see
  Identifiability rank;           ///< which numbers the data determine; empty where find_rank() was not asked
  double chi2 = 0.0;
  numerics::SolveReport report;
  double noise_dof = std::numeric_limits<double>::infinity();  ///< of the noise by which it is whitened
  /// Standard deviations that are estimated from the same data: those of published fits.
  double estimated = 0.0;
  /// Degrees of freedom: whitened numbers less fitted ones and estimated standard deviations, may be
  /// negative.
  [[nodiscard]] double dof() const {
    return static_cast<double>(residual.size()) - static_cast<double>(free) - estimated;
  }
  /// Bayesian information criterion chi2 + k ln n [-].
  [[nodiscard]] double bic() const;
  [[nodiscard]] std::vector<Setting> fitted() const;
  [[nodiscard]] std::vector<Setting> fixed() const;
  [[nodiscard]] std::vector<const Parameter*> parameters() const;  ///< of the fitted ones
};

/// When a fit ends, and who watches it.
struct FitOptions {
  int max_iterations = 50;
  double tolerance = 1e-6;  ///< relative fall of chi2 below which the fit ends
  std::function<bool(int iteration, double chi2)> progress;  ///< false stops the fit
  /// chi2 to come near to: the fit ends where ten more iterations at its pace would not reach it.
  double rival = 0.0;
};

/// Weighted least squares by Ceres (Levenberg-Marquardt, bounds), from one start.      theory.md (I.1)
/// start: coordinates to begin with; `fixed` settings stay.
[[nodiscard]] Fit fit(const Model& model, const Data& data, const std::vector<Setting>& start,
                      const std::vector<Setting>& fixed = {}, const FitOptions& options = {});

/// Fills `rank` of a usable fit: derivatives by twice the step tell the error of those that it has, and a
/// direction that they leave in doubt is null where chi2 rises by less than 1 when the number that moves most
/// is moved along it and held, all others refitted. With null directions the covariance becomes that of
/// `rank`.                                                                                   theory.md (I.32)
void find_rank(const Model& model, const Data& data, Fit& fit);

/// Ends of the interval of one coordinate (in its unit) in which the profile of chi2 [-] (all others
/// refitted) stays within `rise` of its
/// minimum: 3.84 for 95 %. An end at a bound of the number, or where no refit succeeds, is absent.
struct ProfileInterval {
  std::optional<double> lower;
  std::optional<double> upper;
};
/// which: of the fitted settings, from 0. rise of chi2 [-], > 0. progress: as in FitOptions; after false both
/// ends may be absent.
[[nodiscard]] ProfileInterval profile_interval(
    const Model& model, const Data& data, const Fit& optimum, std::size_t which, double rise,
    const std::function<bool(int iteration, double chi2)>& progress = {});

/// Directions D of the coordinates in which the whitened residual changes by one, in columns, D^T J^T J D =
/// 1: by singular values, those below 1e-10 of the largest (columns of J scaled to one) left out. In the
/// units of the columns' coordinates.
[[nodiscard]] Eigen::MatrixXd unit_directions(const Eigen::MatrixXd& jacobian);

/// (J^T J)^-1 = D D^T of these directions, in the units of the columns' coordinates.
[[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& jacobian);

}  // namespace snare::identification
