#pragma once

#include "identification/tracing/attribution.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// Causes that the catalogue does not have: those functions of one channel that explain what the base model
/// leaves no worse than an effect does (chi2 of the fit with it [-]: `explained`), are accepted, and carry
/// over to conditions left out as well as it does (a share of the excess [-], at most 1: `predicted`). Not
/// those that a member of the effect's class (`names`) is in another dress: in its channel, or as the
/// function without slope.
///                                                                                            theory.md (I.8)
[[nodiscard]] std::vector<ChannelFunction> rivals_outside(const std::vector<ChannelFunction>& functions,
                                                          const std::vector<std::string>& names,
                                                          double explained, double predicted);

/// Whether several effects give way to one of these causes: nearly all of it carries over.
[[nodiscard]] bool one_for_several(const std::vector<ChannelFunction>& rivals);

/// Whether one of these causes is simpler than the effects that `current` has: than several together where
/// nearly all of it carries over, and than an effect that leaves something of it.
[[nodiscard]] bool simpler_outside(const std::vector<ChannelFunction>& rivals, const Model& model,
                                   const Data& data, const Fit& current, std::size_t effects);

}  // namespace snare::identification
