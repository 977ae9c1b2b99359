#pragma once

#include "identification/tracing/trace.hpp"

#include <optional>
#include <string>
#include <vector>

/// What is said of a trace in more than one place: trace.json, its page, reproduce.json and the command line.
namespace snare::results {

/// The verdict in a sentence or three, for a person.
[[nodiscard]] std::string verdict(const identification::Trace& trace);

/// Mean standard deviation of a fitted reading [N]; none before the noise is known.
[[nodiscard]] std::optional<double> reading_noise(const identification::Trace& trace);

/// Root mean square distance [N] of a model's forces from the published law that the readings of series k
/// were drawn about; none for a series without one or that the model has not reached.
[[nodiscard]] std::optional<double> law_distance(const identification::Trace& trace, std::size_t k,
                                                 const std::vector<identification::Prediction>& model);

}  // namespace snare::results
