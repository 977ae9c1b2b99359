#pragma once

#include "identification/published/published_map.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace snare::results {

/// What the published fits of an experiment rest on, as a name of the map that belongs to them: wire, mounts,
/// pusher and printed numbers, without the assumed range, and the hypotheses that are weighed.
[[nodiscard]] std::string published_inputs(const identification::Experiment& experiment);

/// A map of hypotheses about published fits, schema snare-published-map/1. p: of a hypothesis by published_p
/// [-], none where it was not asked.
[[nodiscard]] nlohmann::json published_map_json(const identification::Experiment& experiment,
                                                const identification::FitRanges& ranges,
                                                const std::vector<identification::HypothesisMap>& maps,
                                                const std::vector<std::optional<double>>& p, bool coarse);

/// How sure an answer is. A family of hypotheses is explained where it has 0.95 under both priors of the
/// range and its leading member P >= 0.05; most likely from 0.5 under both; none of these where every known P
/// is below 0.01; else the fits cannot tell.
enum class PublishedAnswer { explained, most_likely, none_of_these, cannot_tell };
[[nodiscard]] std::string to_string(PublishedAnswer answer);

/// What published fits show, in two sentences. map: of published_map_json.
struct PublishedVerdict {
  PublishedAnswer answer = PublishedAnswer::cannot_tell;
  std::string headline;
  std::string leading;  ///< model of the map with most probability in the leading family
};
[[nodiscard]] PublishedVerdict published_verdict(const nlohmann::json& map);

}  // namespace snare::results
