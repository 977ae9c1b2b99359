#pragma once

#include "app/report/report_page.hpp"
#include "coupling/dynamics/motion.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

namespace snare::app {

/// What the pages of all scenarios with wires in motion have in common.

/// A number of every sample over time.
[[nodiscard]] Curve time_curve(const std::string& name, int colour, const std::vector<coupling::MotionSample>& samples,
                               const std::function<double(const coupling::MotionSample&)>& value);

/// The outcome of every model of a summary in one table, and what stopped early.
void add_models(const nlohmann::json& models, ReportPage& page);

/// Balance, penetration and cost of one motion, from its summary.
void add_balance(const nlohmann::json& summary, ReportPage& page);

}  // namespace snare::app
