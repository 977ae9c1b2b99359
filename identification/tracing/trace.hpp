#pragma once

#include "identification/tracing/attribution.hpp"
#include "identification/tracing/next_experiment.hpp"
#include "identification/tracing/residual_tests.hpp"
#include "identification/tracing/round.hpp"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::identification {

struct Trace {
  std::vector<Series> series;  ///< as used: a published law replaced by readings drawn about it
  std::vector<bool> heldout;   ///< one a series
  Noise noise;
  bool drawn = false;       ///< readings were drawn about published laws
  double mesh_error = 0.0;  ///< largest discretisation error of the final model [N]
  ModelError declared, base, final;
  std::vector<Setting> final_settings;  ///< of the final model: see Model::apply
  std::vector<Prediction> declared_predictions, base_predictions, final_predictions;  ///< one a series
  ResidualTests base_tests, final_tests;
  bool significant = false;  ///< the base model leaves something
  std::vector<Round> rounds;
  std::vector<std::string> selected;
  /// Of each selected effect: itself and what these data cannot tell from it. Of the first also
  /// "outside:CHANNEL" for every channel of `alternatives`, a cause that the catalogue does not have.
  std::vector<std::vector<std::string>> selected_classes;
  std::vector<std::string> partial;  ///< effects that were added but leave a residual: not selected
  double partial_rmse = 0.0;
  bool rival_explanation = false;  ///< those effects would do, but one function of one channel is the simpler cause
  bool explained = false;
  std::string channel;  ///< of the first effect selected, or where the residual comes from; empty: unknown
  std::vector<ChannelFunction> functions;  ///< when the catalogue does not explain it
  std::vector<ChannelFunction>
      alternatives;  ///< when it does: causes outside it, in other channels, that would as well
  std::optional<std::pair<double, double>> heldout_rmse;  ///< base, final [N]
  std::optional<std::pair<double, double>>
      left_out_rmse;  ///< likewise of every series predicted from the others, to first order
  std::optional<NextExperiment> next;
  std::vector<std::pair<std::string, double>> seconds;  ///< where the time went
  bool interrupted = false;
  numerics::SolveReport report;  ///< of the base fit: without it there is no trace
};

struct TraceOptions {
  std::vector<std::string> free;  ///< keys of the base model; empty: the experiment's own, else the two stiffnesses
  int most_effects = 3;
  double significance = 0.02;           ///< of the first effect's score after Holm: one false alarm in fifty
  double further_significance = 0.002;  ///< of a further effect's: one by chance beside a true one is an error too
  unsigned seed = 1;                    ///< of the noise drawn about published laws
  bool draw = true;       ///< draw it; false: the law itself stands for the readings (for fits, not for tests)
  bool attribute = true;  ///< ask the channels when the catalogue does not explain the residual
  bool intervals = true;  ///< profile likelihood of the selected effects' numbers
  std::function<bool(const std::string& stage)> progress;  ///< false stops
  /// Is given the trace as it would be if it ended here, whenever more of it is whole: after the base fit, and once the final
  /// model is chosen. Marked as interrupted. May be empty.
  std::function<void(const Trace& part)> reached;
};

/// Closes the loop of model and measurement: fits the declared model, tests what is left, finds the effect or the class
/// of effects that the model lacks, adds it, one at a time.                           theory.md (I.1)-(I.7)
/// Throws base::InputError for series that cannot be traced (no readings, fewer than the numbers to fit, all
/// forces equal, never in contact).
[[nodiscard]] Trace trace(const Experiment& experiment, const TraceOptions& options = {});

}  // namespace snare::identification
