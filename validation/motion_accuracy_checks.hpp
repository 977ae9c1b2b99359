#pragma once

#include "validation/suite.hpp"

namespace snare::validation {

/// What the integration of a motion costs in accuracy, and where a slow motion ends: energy of a conservative
/// impact, balances of momentum and angular momentum, convergence with the tolerance, steps against the axial
/// wave.
[[nodiscard]] std::vector<Row> balance_rows();
/// Energy of an impact without any damping, every wave resolved: half a minute.
[[nodiscard]] std::vector<Row> undamped_impact_rows();
[[nodiscard]] std::vector<Row> tolerance_rows();

/// Slow pushes against the static curves: friction that reverses, snap-through.
[[nodiscard]] std::vector<Row> friction_reversal_rows();
[[nodiscard]] std::vector<Row> snap_through_rows();

/// A chain that is held at one end and let go at the other, beside it (Calkin and March 1989).
[[nodiscard]] std::vector<Row> folded_chain_rows();

/// All of them.
[[nodiscard]] std::vector<Check> motion_accuracy_checks();

}  // namespace snare::validation
