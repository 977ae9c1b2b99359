#pragma once

#include "coupling/dynamics/motion.hpp"

#include <nlohmann/json.hpp>

#include <Eigen/Core>

namespace snare::app {

/// What the summaries of all scenarios with wires in motion have in common.                     docs/summary_json.md
[[nodiscard]] nlohmann::json vector_json(const Eigen::Vector3d& v);
/// Ending, energies, errors of the balances, drifts and cost of a motion, added to an object.
void add_result(const coupling::MotionResult& result, nlohmann::json& object);

}  // namespace snare::app
