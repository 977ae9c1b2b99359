#pragma once

#include "identification/ring_down/damping_split.hpp"
#include "identification/ring_down/ring_down_file.hpp"

#include <string>
#include <vector>

namespace snare::app {

inline constexpr double per_mm = 1e3;  ///< from metres

/// The value times `unit` with half its 95 % interval: 12.3 -+ 0.4.
[[nodiscard]] std::string with_error(const identification::Estimate& e, double unit = 1.0);

/// report.html of ring-downs: their damping, a table of the modes, and every record beside its fit.
/// fits: one a series of the file. warnings: what must not be relied on.
[[nodiscard]] std::string ring_down_report_html(const identification::RingDownFile& file,
                                                const std::vector<identification::RingDownFit>& fits,
                                                const identification::DampingSplit& split,
                                                const std::vector<std::string>& warnings);

}  // namespace snare::app
