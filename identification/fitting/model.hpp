#pragma once

#include "identification/fitting/parameter.hpp"
#include "identification/fitting/prediction.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace snare::identification {

/// One number of the model away from its declared value.
struct Setting {
  const Parameter* parameter = nullptr;
  double coordinate = 0.0;
};

/// What a model with these settings says of every series.
struct Evaluation {
  SharedPredictions predictions;
  std::vector<Eigen::VectorXd> force;  ///< one a series, at its readings [N]
  std::vector<Eigen::MatrixXd> by;     ///< d force / d coordinate, a column a parameter asked for
  bool complete = false;               ///< every reading of every series was computed
  std::string message;                 ///< why not
};

/// The declared experiment as a function of settings.                                 theory.md (I.2)
class Model {
 public:
  /// `series` as declared; every evaluation computes all of them, in parallel, with the same bits for any
  /// number of threads. thin: see PredictionOptions.
  Model(std::vector<Series> series, const SolverSettings& solver, bool thin = true);

  [[nodiscard]] const std::vector<Series>& series() const { return series_; }  ///< as declared
  [[nodiscard]] const SolverSettings& solver() const { return solver_; }       ///< how it is solved
  /// Declared value of a number: that of the first series.
  [[nodiscard]] double declared(const Parameter& parameter) const;
  /// As files show it, in its unit.
  [[nodiscard]] double shown(const Setting& setting) const;
  /// Bounds of the coordinate: [-] of a ratio, else in SI units.
  [[nodiscard]] double lower(const Parameter& parameter) const;
  [[nodiscard]] double upper(const Parameter& parameter) const;

  /// Series and records with the settings in place.
  struct Applied {
    std::vector<Series> series;
    std::vector<ReadingModel> reading;  ///< one a series
    bool of_all = true;                 ///< no setting belongs to one series alone
  };
  [[nodiscard]] Applied apply(const std::vector<Setting>& settings) const;

  /// Forces [N], and their derivatives by the coordinates of `by` (settings, or further numbers at their
  /// declared values). Implicit differentiation; central differences of whole curves where
  /// coupling::differentiable() says no. The steps of the differences are `widen` times the usual ones, > 0.
  [[nodiscard]] Evaluation evaluate(const std::vector<Setting>& settings,
                                    const std::vector<const Parameter*>& by = {}, double widen = 1.0) const;

  /// Derivatives by factors of EI on windows of the wire, one a column: hat functions over `windows` evenly
  /// spread stations of the material between the mounts. Empty where the model is not differentiable.
  [[nodiscard]] Evaluation evaluate_windows(const std::vector<Setting>& settings, int windows) const;
  /// Curves of the series of a model; those that `options.stop` ends are interrupted.
  [[nodiscard]] std::vector<Prediction> predict_with(
      const Applied& model, const PredictionOptions& options,
      const std::vector<std::vector<coupling::PushVariation>>& variations = {}) const;

 private:
  /// Derivatives by the numbers of the test by differences of whole curves, into `result`.
  void difference_curves(std::vector<Setting> settings, const std::vector<const Parameter*>& by, double widen,
                         Evaluation& result) const;

  std::vector<Series> series_;
  SolverSettings solver_;
  bool thin_;
};

}  // namespace snare::identification
