#pragma once

#include "identification/motion_tracing/record_trace.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// What one pass over the catalogue needs.
struct RoundInput {
  const RecordModel& model;
  const RecordData& data;
  const RecordFit& current;
  const std::vector<RecordEffect>& effects;
  const std::vector<std::size_t>& selected;  ///< indices of effects that are part of `current`
  double significance = 0.01;
  std::map<std::string, double> tolerance =
      {};  ///< by which a channel's error must fall, as the root of squares
  /// Of the records held out: their readings, and the residual of a fit there (empty: no motion). They choose
  /// among what the fitted ones do not tell apart, and are not asked otherwise.
  const RecordData* heldout_data = nullptr;
  std::function<Eigen::VectorXd(const RecordFit& fit)> heldout = {};
  double heldout_now = 0.0;  ///< sum of squares there of `current`
  std::function<bool(int iteration, double chi2)> progress = {};
};

/// What one pass has found: all candidates, and the model with the effect that was added.
struct RoundResult {
  RecordRound round;
  std::optional<std::size_t> added;  ///< index of the effect
  RecordFit better;
};

/// Whether what a fit leaves is a good part of the motion itself: predictions that have fallen out of step
/// with the readings, and derivatives there that lead to no better ones.                     theory.md (I.29)
[[nodiscard]] bool out_of_step(const RecordData& data, const RecordFit& fit);

/// Scores, refits of the most promising, classes by what the refits predict, and the effect to add, if any:
/// theory.md (I.22). Of a fit that is out of step all effects are refitted that are significant, since what
/// their scores promise is little then, and the best to the end.
[[nodiscard]] RoundResult record_round(const RoundInput& input);

}  // namespace snare::identification
