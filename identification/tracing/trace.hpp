#pragma once

#include "identification/fitting/serial_noise.hpp"
#include "identification/tracing/attribution.hpp"
#include "identification/tracing/hypotheses.hpp"
#include "identification/tracing/next_experiment.hpp"
#include "identification/tracing/residual_tests.hpp"
#include "identification/tracing/round.hpp"
#include "identification/tracing/verdict.hpp"
#include "identification/tracing/zero_check.hpp"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::identification {

/// All that a tracing has found, as trace.json tells it; usable or not says its report.
struct Trace {
  std::vector<Series> series;  ///< as used: a published law at its travels instead of readings
  std::vector<bool> heldout;   ///< one a series
  Noise noise;
  std::optional<SerialNoise> serial;  ///< of the final model, where its residual is autocorrelated
  bool serial_rival = false;  ///< with such noise the base model is as likely as the effects that were found
  bool from_laws = false;     ///< published fits replace lost readings: only their four numbers count
  std::size_t rows = 0;       ///< readings, and numbers of published fits, that are fitted
  double mesh_error = 0.0;    ///< largest discretisation error of the final model [N]
  ModelError declared, base, final;
  std::vector<Setting> final_settings;  ///< of the final model: see Model::apply
  std::vector<Prediction> declared_predictions,
      base_predictions;                 ///< one a series: the forces, without their curves
  SharedPredictions final_predictions;  ///< one a series
  ResidualTests base_tests, final_tests;
  bool significant = false;  ///< the base model leaves something
  std::vector<Round> rounds;
  std::vector<std::string> selected;
  /// Of each selected effect: itself and what these data cannot tell from it. Of the first also
  /// "outside:CHANNEL" for every channel of `alternatives`, a cause that the catalogue does not have.
  std::vector<std::vector<std::string>> selected_classes;
  std::vector<std::string> partial;  ///< effects that were added but leave too much: not selected
  double partial_rmse = 0.0;
  /// Those effects would do, but one function of one channel is the simpler cause.
  bool rival_explanation = false;
  VerdictKind kind = VerdictKind::not_explained;
  bool explained = false;  ///< nothing is missing, or the selected effects explain what is
  /// explained, and nothing speaks against the answer being the only one: is_decided().
  bool decided = false;
  /// One more number would leave too few degrees of freedom: effects were not asked.
  bool few_readings = false;
  bool one_condition = false;  ///< one position and one slack: channels cannot be told from each other
  double tolerance = 0.0;      ///< error below which nothing is called missing [N]
  double peak_force = 0.0;     ///< largest measured one [N]
  Remaining remaining;
  std::vector<Finding> findings;      ///< of the final model
  std::vector<PlaceEstimate> places;  ///< by the final model, of tests whose place is not declared exact
  std::optional<ZeroCheck> zero;      ///< beside a final model that has none
  std::string channel;  ///< of the first effect selected, or where the residual comes from; empty: unknown
  std::vector<ChannelFunction> functions;  ///< when the catalogue does not explain it
  /// When it does: causes outside it, in other channels, that would as well.
  std::vector<ChannelFunction> alternatives;
  std::vector<CauseHypothesis> hypotheses;                ///< weighed, best first; none for published fits
  std::optional<std::pair<double, double>> heldout_rmse;  ///< base, final [N]
  /// Likewise of every condition predicted from the others, to first order.
  std::optional<std::pair<double, double>> left_out_rmse;
  std::optional<NextExperiment> next;
  std::vector<std::pair<std::string, double>> seconds;  ///< where the time went
  bool interrupted = false;
  numerics::SolveReport report;  ///< of the base fit: without it there is no trace
};

/// How far a tracing goes, at which levels, and who watches it.
struct TraceOptions {
  /// Keys of the base model; empty: the experiment's own, else the two stiffnesses.
  std::vector<std::string> free;
  int most_effects = 3;
  double significance = 0.02;  ///< of the first effect's score after Holm: one false alarm in fifty
  double further_significance =
      0.0001;             ///< of a further effect's: one by chance beside a true one is an error too
  bool attribute = true;  ///< ask the channels when the catalogue does not explain the residual
  bool intervals = true;  ///< profile likelihood of the selected effects' numbers
  std::function<bool(const std::string& stage)> progress;  ///< false stops
  /// Asked between the points of curves with every reading; true ends the trace there: its report is
  /// `interrupted`. May be empty.
  std::function<bool()> stop;
  /// Is given the trace as it would be if it ended here, whenever more of it is whole: after the base fit,
  /// and once the final model is chosen. Marked as interrupted. May be empty.
  std::function<void(const Trace& part)> reached;
};

/// Closes the loop of model and measurement: fits the declared model, tests what is left, finds the effect or
/// the class of effects that the model lacks, adds it, one at a time.                   theory.md (I.1)-(I.7)
/// Throws base::InputError for series that cannot be traced (no readings, fewer than the numbers to fit, all
/// forces equal, never in contact).
[[nodiscard]] Trace trace(const Experiment& experiment, const TraceOptions& options = {});

}  // namespace snare::identification
