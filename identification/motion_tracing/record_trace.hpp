#pragma once

#include "identification/motion_effects/record_effect.hpp"
#include "identification/motion_tracing/leftover.hpp"
#include "identification/motion_tracing/record_score.hpp"
#include "identification/records/profile.hpp"
#include "identification/records/record_fit.hpp"
#include "identification/tracing/verdict.hpp"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::identification {

/// A number after a fit, in the unit of its key.
struct TracedNumber {
  std::string key, unit;
  double value = 0.0, stderr_ = 0.0;
  /// 95 %, of correlated residuals; absent where the records do not show it, and at the bound on which the
  /// number stands.
  std::optional<double> lower, upper;
  AtBound bound = AtBound::none;  ///< on which it stands
  bool identified = true;  ///< the records change with it, and no null direction moves it: theory.md (I.32)
};

/// Numbers that move together while no reading changes: theory.md (I.32).
struct OpenNumbers {
  std::vector<NamedChange> changes;  ///< the number that moves most first: the one to hold
  double held = 0.0;                 ///< value of that, in its unit
  std::vector<TracedNumber> known;   ///< the others, with the first number of every direction held
};

/// Error of one channel over some records.
struct ChannelError {
  std::string sensor, unit;
  bool fitted = true;
  double rmse = 0.0;      ///< in the unit of the channel
  double nrmse = 0.0;     ///< over the range of the measured values
  double relative = 0.0;  ///< norm of the error over that of the readings
  double sigma = 0.0;     ///< of a reading: declared, or from second differences of the readings
};

/// One model of a trace with what it leaves.
struct RecordStage {
  std::vector<TracedNumber> numbers;
  std::vector<OpenNumbers> open;     ///< null directions of the records
  std::vector<ChannelError> errors;  ///< of the fitted records
  /// Of the others; numbers of every record for itself are fitted to them, nothing else.
  std::vector<ChannelError> heldout;
  double rmse = 0.0,
         nrmse = 0.0;     ///< over the fitted channels: in the unit of the only one, else over their scales
  double chi2_dof = 0.0;  ///< against the noise
  double heldout_rmse = 0.0;
  std::vector<RecordPrediction> predictions;  ///< of all records of the set, in its order
};

/// An effect beside the model of a round.
struct RecordCandidate {
  RecordScore score;
  bool refitted = false;
  double rmse = 0.0;       ///< after the refit, as RecordStage::rmse, in the unit of the channel or [-]
  double delta_bic = 0.0;  ///< of the refit, of prewhitened residuals
  std::vector<TracedNumber> numbers;    ///< of the effect after the refit, as the keys are set
  std::vector<RecordSetting> settings;  ///< the same, as the fit has them: counted from what is declared
  bool plausible = true;
  std::string why_not;  ///< it is not named although it is significant
  std::optional<bool> heldout_improves;
  std::size_t class_index = 0;
};

/// One round: candidates, their classes, and which was added and why, or why none.
struct RecordRound {
  std::vector<RecordCandidate> candidates;        ///< ranked, best first
  std::vector<std::vector<std::string>> classes;  ///< of labels
  std::string added, reason;
};

/// What another kind of model, by other keys, takes the free numbers for in the base fit.
struct ModelFamily {
  std::string name;
  std::vector<TracedNumber> numbers;
  double chi2_dof = 0.0;  ///< against the noise [-]
  long simulations = 0;
  std::string failure;  ///< why there are no numbers; empty: there are
};

/// All that the tracing of a scenario has found, as trace.json tells it.
struct RecordTrace {
  std::vector<RecordEffect> effects;
  RecordStage declared, base, final;
  std::string noise_source;  ///< "declared", "second_differences"
  double sigma = 0.0;        ///< of the fitted channels together, as RecordStage::rmse
  bool significant = false;  ///< what the base leaves
  double ljung_box = 1.0, runs = 1.0, lack_of_fit = 1.0;  ///< p of the base's residual
  std::vector<RecordRound> rounds;
  std::vector<std::string> selected;  ///< labels
  std::vector<std::size_t> selected_effects;
  /// Labels of effects that help without explaining: none of them is named.
  std::vector<std::string> partial;
  std::optional<RecordStage> with_partial;
  VerdictKind kind = VerdictKind::nothing_missing;
  double share_left = 0.0;  ///< of what the base leaves beside the noise, as mean squares [-]
  /// Of the first effect selected; not explained: the sensor with most beside its noise.
  std::string channel;
  std::vector<Leftover> leftovers;
  std::vector<Profile> profiles;      ///< of the numbers for which they are asked, in the final model
  std::vector<ModelFamily> families;  ///< of the base fit, as the file lists them
  std::vector<Finding> findings;
  std::vector<std::string> warnings;  ///< what of this is doubtful, a sentence each
  std::string next_measurement;
  std::vector<std::string> next_separates;
  long simulations = 0;
  int fit_iterations = 0;
  long fit_simulations = 0;  ///< of the base fit
  bool interrupted = false;
  numerics::SolveReport report;
};

}  // namespace snare::identification
