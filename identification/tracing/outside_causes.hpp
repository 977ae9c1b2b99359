#pragma once

#include "identification/tracing/attribution.hpp"

#include <vector>

namespace snare::identification {

/// Causes that the catalogue does not have: those functions of one channel that explain what the base model
/// leaves no worse than the effects do (chi2 of them [-]: `explained`), and carry over to series that they were
/// not found in. Not
/// those in the channel of the effect itself, where they are that effect in another dress.    theory.md (I.8)
[[nodiscard]] std::vector<ChannelFunction> rivals_outside(const std::vector<ChannelFunction>& functions, Channel effect,
                                                          double explained);

/// Whether one of these causes is simpler than the effects that `current` has: than several together, and
/// than an effect that leaves something of it.
[[nodiscard]] bool simpler_outside(const std::vector<ChannelFunction>& rivals, const Model& model, const Data& data,
                                   const Fit& current, std::size_t effects);

}  // namespace snare::identification
