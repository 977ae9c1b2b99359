#pragma once

#include "results/motion_record.hpp"
#include "scenario/world.hpp"

#include <string>
#include <vector>

namespace snare::app {

using namespace results;

/// The report on motions with wires, as HTML. version: of the command.
[[nodiscard]] std::string motion_page(const scenario::Scenario& asked, const scenario::WireMotions& motions,
                                      const std::vector<FinishedMotion>& finished, const std::string& version,
                                      const std::vector<std::string>& warnings, bool interrupted);

/// The report on an arm alone, as HTML.
[[nodiscard]] std::string arm_page(const scenario::Scenario& asked, const scenario::ArmMotion& motion,
                                   const ArmRecord& record, const std::string& version);

}  // namespace snare::app
