#pragma once

#include "identification/fitting/published_fit.hpp"
#include "identification/tracing/trace.hpp"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace snare::app {

/// A number of a model in its unit.
struct ReproducedNumber {
  double value = 0.0;
  std::optional<double> standard_error;  ///< none: declared or held
  std::string unit;
};

/// A model of the wire beside the published curves.
struct ReproducedModel {
  std::string name;                                      ///< "declared", "best_fit" or "traced"
  std::string label;                                     ///< in words, lower case
  std::string description;                               ///< one sentence
  std::map<std::string, ReproducedNumber> numbers = {};  ///< by key of the experiment file
  int free = 0;                                          ///< how many of them were fitted
  std::vector<identification::Prediction> predictions =
      {};  ///< one a series; fewer when it was not computed at all

  /// Null where the model was not computed.
  [[nodiscard]] const identification::Prediction* at(std::size_t series) const;
  /// Over all readings of the experiment that were reached; none without any prediction.
  [[nodiscard]] std::optional<identification::Misfit> misfit(
      const identification::Experiment& experiment) const;
  /// Computed at every position to the end of the push.
  [[nodiscard]] bool complete(const identification::Experiment& experiment) const;
};

/// The leading explanation of published fits, fitted again at its ranges and number of readings.
struct RefittedLeader {
  std::string model, meaning;                     ///< "mounts_give_and_turn", "the mounts give way and turn"
  int readings = 0;                               ///< of each series
  double p = 1.0;                                 ///< SummaryStatistics::p there
  std::map<std::string, double> values;           ///< by key, in the unit of the key
  identification::Experiment experiment;          ///< the declared test of this explanation, over its ranges
  std::vector<identification::Setting> settings;  ///< its fitted numbers
};

/// What `snare reproduce` computes. A run that was interrupted has fewer models, no trace, no map.
struct Reproduction {
  identification::Experiment experiment;
  std::vector<std::string> assumptions;
  std::vector<ReproducedModel> models;  ///< in the order in which they are shown, the declared one first
  std::optional<identification::Trace> trace;
  std::optional<identification::SummaryStatistics> summary;  ///< of the best fit; none without published fits
  /// The same with R2 printed to so many decimals.
  std::map<int, identification::SummaryStatistics> by_digits;
  /// Of how the fits may have come about, results/published_map.hpp; or null.
  std::shared_ptr<const nlohmann::json> map;
  std::optional<RefittedLeader> leader;  ///< of the map
  std::vector<std::string> warnings;     ///< doubts about the models
  bool interrupted = false;              ///< only a part of the result was computed

  /// The model of least overall error, complete ones first, since an error over less is no smaller error;
  /// null when no model has one.
  [[nodiscard]] const ReproducedModel* best_model() const;
};

/// Why a prediction ended early; empty when it did not.
[[nodiscard]] std::string reason_stopped(const identification::Prediction& prediction);

/// Scatter of the readings about the published curve [N]: of the law, or as declared.
[[nodiscard]] std::optional<double> published_scatter(const identification::Series& series);

/// dF/dd [N/mm] of a curve by central differences, one-sided at its ends. displacement [m], force [N].
[[nodiscard]] std::vector<double> tangent_stiffness(const std::vector<double>& displacement,
                                                    const std::vector<double>& force);

/// The same of the published curve: 2 A d + B of a law, else by differences.
[[nodiscard]] std::vector<double> published_stiffness(const identification::Series& series);

/// Largest computed force [N], >= 0.
[[nodiscard]] double largest_force(const identification::Prediction& prediction);

}  // namespace snare::app
