#pragma once

#include "identification/tracing/discrepancies.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// What may be behind the readings: the base model, with effects of the catalogue, with an unknown function,
/// or with both.
struct CauseHypothesis {
  std::vector<std::string> effects;  ///< of the catalogue
  std::string discrepancy;           ///< variable of an unknown function, see Discrepancy; empty: none
  /// Of the readings, its own prior included, up to a constant of all hypotheses [-].
  double log_evidence = 0.0;
  double probability = 0.0;  ///< of all hypotheses [-]
};

/// A model that was fitted: the base model's numbers first, then those of its effects.
struct FittedModel {
  std::vector<std::string> effects;  ///< none: the base model
  Fit fit;                           ///< its evaluation may be empty
};

/// Weighs hypotheses by their marginal likelihoods, best first; the probabilities sum to one.
///                                                                                           theory.md (I.37)
/// models: the base model first. Noise: as the data have it, independent or autocorrelated within a series;
/// its size is marginalised where it is not declared. Unknown functions are added to the base model and to
/// the three best models with effects. Empty for published fits.
[[nodiscard]] std::vector<CauseHypothesis> weigh_hypotheses(const Model& model, const Data& data,
                                                            const std::vector<FittedModel>& models);

/// The unknown function that is likeliest among the hypotheses without effects.
struct OutsideCause {
  std::string variable;      ///< empty: there is none
  double probability = 0.0;  ///< of all hypotheses with an unknown function and no effect [-]
};
[[nodiscard]] OutsideCause outside_cause(const std::vector<CauseHypothesis>& hypotheses);

}  // namespace snare::identification
