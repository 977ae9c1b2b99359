#pragma once

#include "results/motion_record.hpp"
#include "scenario/world.hpp"

#include <string>
#include <vector>

namespace snare::app {

using namespace results;

/// The report on a motion, as HTML. version: of the command.
[[nodiscard]] std::string motion_page(const scenario::Scenario& asked, const FinishedMotion& finished,
                                      const std::string& version, const std::vector<std::string>& warnings,
                                      bool interrupted);

}  // namespace snare::app
