#pragma once

#include "reduction/compare.hpp"

#include <string>
#include <vector>

namespace snare::app {

/// report.html of a comparison: accuracy and cost of every model, a table and two plots a case. interrupted:
/// cases are missing.
[[nodiscard]] std::string compare_report_html(const std::string& title,
                                              const std::vector<reduction::CaseComparison>& cases,
                                              bool interrupted);

}  // namespace snare::app
