#pragma once

#include "reduction/distil.hpp"

#include <string>

namespace snare::app {

/// report.html of a distillation: the stiffness of the linear spring against the travel for every position
/// (as Abiko et al., Fig. 11), forces and errors of the laws, the table's bound, the map of the closed forms.
[[nodiscard]] std::string distil_report_html(const reduction::WireFile& file,
                                             const reduction::Distillation& distillation,
                                             const std::vector<std::string>& warnings = {});

}  // namespace snare::app
