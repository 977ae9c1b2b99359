#pragma once

#include "app/report/reproduce_result.hpp"

#include <string>

namespace snare::app {

/// The page of `snare reproduce`.
///
/// What was not computed is left out or shown as a dash, and what stopped early is said so: a page can be had
/// from any run. Throws std::invalid_argument, naming plot and curve, when a value of a curve is not finite.
[[nodiscard]] std::string reproduce_report_html(const Reproduction& result, const std::string& version);

}  // namespace snare::app
