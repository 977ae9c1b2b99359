#pragma once

#include "identification/fitting/experiment.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace snare::identification {

/// Puts readings in the place of published laws: the law at its travels, with noise of the scatter that its
/// R^2 implies (`draw`, from a seed) or without. A series without a declared sigma gets that scatter. Whether
/// noise was drawn.
[[nodiscard]] bool replace_laws(std::vector<Series>& series, bool draw, unsigned seed);

/// Refuses series that cannot be traced: without readings, with the same force throughout, with forces that do not
/// follow the travel. Throws base::InputError naming them all. heldout: one a series; these need only readings.
void check_readings(const std::filesystem::path& file, const std::vector<Series>& series,
                    const std::vector<bool>& heldout);

/// Numbers that are fitted when the experiment names none: the two stiffnesses, on supports that of bending.
[[nodiscard]] std::vector<std::string> default_free(const Experiment& experiment);

}  // namespace snare::identification
