#pragma once

#include "app/report/report_page.hpp"
#include "app/report/reproduce_result.hpp"

#include <string>

namespace snare::app {

/// "s = 40 mm", the position of a series in the words of its plots and tables.
[[nodiscard]] std::string series_title(const identification::Series& series);

/// Force and tangent stiffness at all positions: published beside the best model.
void add_overview(ReportPage& page, const Reproduction& result);

/// The section of series k: published law, what stopped, forces, residuals, stiffness, shapes, tension,
/// moment.
void add_series(ReportPage& page, const Reproduction& result, std::size_t k);

}  // namespace snare::app
