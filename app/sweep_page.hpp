#pragma once

#include "app/sweep_answers.hpp"

#include <string>

namespace snare::app {

/// report.html of a sweep: what its cases say together.
[[nodiscard]] std::string sweep_page(const SweepStudy& study, const SweepAnswers& answers);

}  // namespace snare::app
