#pragma once

#include "identification/fitting/prediction.hpp"
#include "results/watch.hpp"

#include <nlohmann/json.hpp>

#include <vector>

namespace snare::results {

/// What the declared model of an experiment predicts.
// NOLINTNEXTLINE(bugprone-exception-escape): moving a document throws nothing.
struct PushResult {
  std::vector<identification::Prediction> predictions;  ///< one a series
  nlohmann::json document;                              ///< "snare-push/1"

  /// Every series was followed to its end.
  [[nodiscard]] bool complete() const;
};

/// The force-displacement curves of every series. A series that could not be followed to its end keeps what
/// was reached; why is under "stopped" of it.
[[nodiscard]] PushResult push(const identification::Experiment& experiment, const Watch& watch = {});

}  // namespace snare::results
