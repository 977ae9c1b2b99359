#pragma once

#include "identification/fitting/identifiability.hpp"
#include "identification/records/record_model.hpp"
#include "numerics/report.hpp"

#include <Eigen/Core>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// Standard deviations by which the channels are weighed, by sensor.
using ChannelScales = std::map<std::string, double>;

/// One stretch of a stacked residual: a fitted channel of a record, from its first reading on.
struct ResidualPiece {
  std::size_t record = 0, channel = 0;  ///< indices in the set
  Eigen::Index begin = 0, size = 0;
  double scale = 1.0;  ///< of its channel, in the unit of that
};

/// The readings that are compared.
struct RecordData {
  const RecordSet* set = nullptr;
  std::vector<std::size_t> records;
  std::vector<Eigen::Index> readings;  ///< of each record from its first on; empty: all
  std::vector<ResidualPiece> pieces;
  Eigen::Index rows = 0;

  /// Place of a record among `records`, and so among predictions of them.
  [[nodiscard]] std::size_t place_of(std::size_t record) const;
  /// (measured - predicted) / scale [-], piece by piece; empty where a prediction failed.
  [[nodiscard]] Eigen::VectorXd residual(const std::vector<RecordPrediction>& predictions) const;
  /// Predicted / scale [-], likewise.
  [[nodiscard]] Eigen::VectorXd signal(const std::vector<RecordPrediction>& predictions) const;
};
[[nodiscard]] RecordData record_data(const RecordSet& set, const std::vector<std::size_t>& records,
                                     const ChannelScales& scales);

/// The same with the first readings of every piece only, a share > 0 of them [-]; nothing where a piece has
/// fewer than `fewest` of them.
[[nodiscard]] std::optional<RecordData> beginnings(const RecordData& data, double share, Eigen::Index fewest);

/// Root mean square of every channel over its records, less its mean: scales to begin with. Declared ones
/// stay.
[[nodiscard]] ChannelScales first_scales(const RecordSet& set, const std::vector<std::size_t>& records);

/// What a fit of records has found; usable or not says its report.
struct RecordFit {
  std::vector<RecordSetting> settings;
  std::vector<RecordPrediction> predictions;
  Eigen::VectorXd residual;
  /// Of the signal by the numbers, each over its scale: as RecordFitOptions::derivatives.
  Eigen::MatrixXd jacobian;
  Eigen::MatrixXd covariance;  ///< of the numbers in their units, of residuals that are correlated
  Identifiability rank;        ///< which numbers the records determine; empty where find_rank() was not asked
  /// Where find_rank() met a sum of squares that is clearly lower: the answer is no minimum. Empty: nowhere.
  std::vector<RecordSetting> lower;
  double chi2 = 0.0;     ///< sum of squares of the residual [-]
  long simulations = 0;  ///< that it took
  int iterations = 0;
  numerics::SolveReport report;
};

/// Derivatives that a fit gives beside its numbers.
enum class FitDerivatives {
  last,    ///< those with which the search ended, which cost nothing, without a covariance
  search,  ///< the same, and the covariance by them: to compare models
  central  ///< central differences at its end, and the covariance by them
};

/// How records are fitted, when that ends, and who watches it.
struct RecordFitOptions {
  FitMethod method = FitMethod::gauss_newton;
  int max_iterations = 60;
  double tolerance = 1e-5;      ///< relative fall of chi2 below which the fit ends
  double simplex_change = 0.0;  ///< as RecordSet::simplex_change; 0: by `tolerance`
  FitDerivatives derivatives = FitDerivatives::central;
  Eigen::MatrixXd first_jacobian;    ///< of the signal at the start, where known; else empty
  std::vector<RecordSetting> fixed;  ///< beside the fitted ones
  std::function<bool(int iteration, double chi2)> progress;  ///< false stops
};

/// Settings that are fitted with those that are not.
[[nodiscard]] std::vector<RecordSetting> together(std::vector<RecordSetting> settings,
                                                  const std::vector<RecordSetting>& fixed);

}  // namespace snare::identification
