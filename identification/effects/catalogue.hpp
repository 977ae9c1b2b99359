#pragma once

#include "identification/effects/effect.hpp"
#include "identification/fitting/parameter_set.hpp"

#include <string_view>
#include <vector>

namespace snare::identification {

/// Every effect, in the order in which equals are listed.
[[nodiscard]] const std::vector<Effect>& catalogue();

/// Null when there is none of this name.
[[nodiscard]] const Effect* find_effect(std::string_view name);

/// Every number that a fit may change: those of the effects and those of the declared construction.
[[nodiscard]] const ParameterSet& parameters();

}  // namespace snare::identification
