#pragma once

#include "identification/fitting/finding.hpp"
#include "identification/fitting/least_squares.hpp"

#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// A number of a fitted model, in its unit.
struct FittedNumber {
  std::string key;
  std::string unit;
  double declared = 0.0;
  double value = 0.0;
  std::optional<double> standard_error;  ///< none where the readings do not determine the number
  /// Of the 95 % interval: by Student's t of the noise's degrees of freedom, unless by one of the two below.
  /// An end that is not admissible is absent, and so is that at the bound on which the number stands.
  std::optional<double> lower;
  std::optional<double> upper;
  bool profiled = false;  ///< profile likelihood
  bool averaged = false;  ///< over the effects that may be the right ones instead of what is selected
  /// With every fitted number, itself among them, in their order; empty where there is no standard error.
  std::vector<double> correlation = {};
  AtBound bound = AtBound::none;  ///< on which it stands
  bool identified = true;         ///< no null direction of the readings moves it: theory.md (I.32)
};

/// Numbers that move together while no reading changes: theory.md (I.32).
struct OpenDirection {
  std::vector<NamedChange> changes;  ///< the number that moves most first: the one to hold
  double held = 0.0;                 ///< value of that, in its unit
  std::vector<FittedNumber> known;   ///< the others, with the first number of every direction held
};

/// Errors of a model over the fitted series.
struct ModelError {
  double rmse = 0.0;   ///< [N]
  double nrmse = 0.0;  ///< over the range of the measured force [-]
  double chi2_dof = 0.0;
  std::vector<double> series_rmse;  ///< one a series of the experiment, held-out ones too [N]
  std::vector<FittedNumber> numbers;
  std::vector<OpenDirection> open;  ///< null directions of the readings
};

/// The fitted numbers of a model with their standard errors and 95 % intervals.
[[nodiscard]] std::vector<FittedNumber> numbers_of(const Model& model, const Fit& fit);

/// The null directions of a fit whose rank was asked.
[[nodiscard]] std::vector<OpenDirection> open_directions(const Model& model, const Fit& fit);

/// Fitted numbers that stand on a bound, and null directions.
[[nodiscard]] std::vector<Finding> number_findings(const Model& model, const Fit& fit);

/// all: every series; heldout: one a series; predictions: of the fitted model, one a series; model: of the
/// fitted series.
[[nodiscard]] ModelError model_error(const std::vector<Series>& all, const std::vector<bool>& heldout,
                                     const std::vector<Prediction>& predictions, const Model& model,
                                     const Fit& fit);

/// Root mean square of measured less computed forces over the fitted readings [N].
[[nodiscard]] double fitted_rmse(const Data& data, const Evaluation& evaluation);

/// Readings of the conditions that are left out one by one, as rows of the data: the positions, the slacks;
/// with one of each the legs of the path; with one leg the last third of the travel.
struct LeftOut {
  std::vector<std::vector<Eigen::Index>> rows;
  bool several = false;  ///< positions or slacks
};
[[nodiscard]] LeftOut left_out_conditions(const Model& model, const Data& data);

/// Root mean square error [N] of every condition predicted by a fit to the others, to first order. theory.md
/// (I.5)
[[nodiscard]] double left_out_rmse(const Model& model, const Data& data, const Fit& fit);

/// Squares of the same errors, whitened, less what noise alone would leave: excess of chi2 [-].
[[nodiscard]] double left_out_excess(const Model& model, const Data& data, const Fit& fit);

/// Series that are never fitted, with their readings.
class HeldOut {
 public:
  HeldOut(const std::vector<Series>& series, const SolverSettings& solver);
  [[nodiscard]] bool empty() const { return !model_; }  ///< no series is held out
  /// Of the model with these settings [N]; absent without such series and where a curve ends early.
  [[nodiscard]] std::optional<double> rmse(const std::vector<Setting>& settings) const;

 private:
  std::optional<Model> model_;
  std::vector<Eigen::VectorXd> measured_;
};

/// Predictions without their curves, which models that are not the final one do not need.
[[nodiscard]] std::vector<Prediction> forces_only(const std::vector<Prediction>& predictions);

/// Forces of a series' readings [N].
[[nodiscard]] Eigen::VectorXd forces_of(const Series& series);

}  // namespace snare::identification
