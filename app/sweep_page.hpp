#pragma once

#include "results/sweep_answers.hpp"

#include <string>

namespace snare::app {

/// report.html of a sweep: what its cases say together.
[[nodiscard]] std::string sweep_page(const results::SweepStudy& study, const results::SweepAnswers& answers);

}  // namespace snare::app
