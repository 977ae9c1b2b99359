#pragma once

#include "identification/tracing/model_error.hpp"
#include "identification/tracing/progress.hpp"
#include "identification/tracing/remainder.hpp"
#include "identification/tracing/score.hpp"
#include "identification/tracing/start_search.hpp"

#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// An effect beside the model of one round.
struct Candidate {
  Score score;
  std::optional<SearchedStart> searched;  ///< where a few steps from finite sizes led
  bool refitted = false;
  double refit_p = 1.0;    ///< of the fall of chi2 in the refit [-], all effects and starts counted
  double rmse = 0.0;       ///< after the refit [N]
  double delta_bic = 0.0;  ///< of the refit, against the round's model: negative is better
  std::vector<FittedNumber> numbers;  ///< of the effect after the refit
  bool plausible = true;
  std::string why_implausible;
  /// what it changes is not worth a name, or the readings cannot bear it; empty: it may be
  std::string why_too_small;
  std::optional<bool> heldout_improves;
  std::size_t class_index = 0;
};

/// The forces of a refit, for a look beside others.
struct RefitCurves {
  std::string effect;
  std::vector<std::vector<double>> force;  ///< one vector a fitted series, at its readings [N]
};

/// One pass over the catalogue.
struct Round {
  std::vector<Candidate> candidates;              ///< ranked, best first
  std::vector<std::vector<std::string>> classes;  ///< effects that these data cannot tell apart
  std::string added;                              ///< effect that was added, empty for none
  std::string reason;                             ///< why it was, or why none was
  std::vector<RefitCurves> curves;                ///< of the best refit and its three best rivals, best first
};

/// A round with the fits behind it.
struct RoundFits {
  Round round;
  Fit better;  ///< the model with the added effect
  /// The added effect's numbers as first tried, of one that has only finite trials.
  std::vector<Setting> begun;
  /// Refits of the first effect's class, then all others that make sense, best first;
  std::vector<Fit> rivals;
  ///< without their curves
  std::vector<std::string> rival_names;  ///< of their effects
};

/// The model of a round.
struct Current {
  const Fit& fit;
  Remainder left;  ///< beside the noise
  /// Its numbers where they were begun: those of the base fit, and the first trials of the effects added
  /// since. Beside another missing effect thresholds run astray, and what they are refitted from then holds
  /// them there. Empty: no such.
  std::vector<Setting> anew;
  /// Every effect is looked for from finite sizes: a base model that leaves more than noise.
  bool search = false;
};

/// What an effect must bring to be named.
struct AcceptanceCriteria {
  double significance = 0.0;  ///< of its score after Holm
  double tolerance = 0.0;  ///< by which the root mean square error must fall [N]; 0: by what is significant
  double refits = 1.0;     ///< effects and starts among which refits are chosen
};

/// Degrees of freedom that must be left beside `numbers` fitted numbers.
[[nodiscard]] double fewest_dof(std::size_t numbers);

/// Scores of every effect beside `current`, refits of the best, ranking, classes, and the effect to add, if
/// any.
/// number: of the round, from 1.                                                      theory.md (I.4), (I.5)
[[nodiscard]] RoundFits look_for_effect(const Model& model, const Data& data, const HeldOut& heldout,
                                        const Current& current, std::size_t number,
                                        const AcceptanceCriteria& demands, Progress& progress);

}  // namespace snare::identification
